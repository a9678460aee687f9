#include "osculate/contact/master_filter.hpp"

#include "contact/area_vector.hpp"
#include "osculate/core/rounded_sum.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

namespace osculate::contact {

namespace {

/// Whether a vertex has facets all around it and no feature edge.
std::vector<char> smooth_vertices(const mesh::HalfEdgeSurface& surface) {
    std::vector<char> smooth(static_cast<std::size_t>(surface.vertex_count()), 1);
    for (Index v = 0; v < surface.vertex_count(); ++v)
        if (surface.is_boundary_vertex(v)) smooth[static_cast<std::size_t>(v)] = 0;
    for (std::size_t h = 0; h < surface.half_edges().size(); ++h) {
        if (!surface.is_feature_edge(static_cast<Index>(h))) continue;
        const mesh::HalfEdge& edge = surface.half_edges()[h];
        smooth[static_cast<std::size_t>(edge.origin)] = 0;
        smooth[static_cast<std::size_t>(surface.half_edges()[static_cast<std::size_t>(edge.next)].origin)] = 0;
    }
    return smooth;
}

/// v x as a matrix.
Mat3 cross_matrix(const Vec3& v) {
    Mat3 m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
}

} // namespace

Mat3 mesh_metric(std::span<const std::vector<Vec3>> facets) {
    Mat3 metric = Mat3::Zero();
    for (const std::vector<Vec3>& X : facets) {
        // of a quadrilateral a a^T + b b^T, a and b its mean edges; of a triangle two thirds of that of its edges, which is
        // h^2 I where they are equal. Both are the same from every corner
        Mat3 spread = Mat3::Zero();
        Vec3 area;
        if (X.size() == 4) {
            const Vec3 a = (X[1] - X[0] + X[2] - X[3]) / 2, b = (X[3] - X[0] + X[2] - X[1]) / 2;
            spread = a * a.transpose() + b * b.transpose();
            area = a.cross(b);
        } else {
            for (std::size_t c = 0; c < 3; ++c) {
                const Vec3 edge = X[(c + 1) % 3] - X[c];
                spread += edge * edge.transpose() * (2.0 / 3);
            }
            area = (X[1] - X[0]).cross(X[2] - X[0]);
        }
        const double size = area.norm(); // any, across the facet
        const Mat3 across = area * area.transpose() / (size * size);
        metric += ((spread + size * across).inverse() - across / size) / static_cast<double>(facets.size());
    }
    return metric;
}

MasterFilter::MasterFilter(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X, const Mat3& metric)
    : surface_(&surface), m_(X.size(), 0.0) {
    std::vector<Vec3> area(static_cast<std::size_t>(surface.facet_count()));
    for (Index f = 0; f < surface.facet_count(); ++f) {
        const auto corners = surface.facet_vertices(f);
        area[static_cast<std::size_t>(f)] = area_vector(corners, X);
        for (const Index v : corners)
            m_[static_cast<std::size_t>(v)] +=
                area[static_cast<std::size_t>(f)].norm() / static_cast<double>(corners.size());
    }
    const std::vector<char> smooth = smooth_vertices(surface);
    for (Index v = 0; v < surface.vertex_count(); ++v) {
        if (smooth[static_cast<std::size_t>(v)] == 0) continue;
        double ratio = std::numeric_limits<double>::infinity();
        std::map<Index, double> L{{v, 1.0}};
        Vec3 n = Vec3::Zero();
        for (const Index f : surface.vertex_facets(v)) {
            const auto corners = surface.facet_vertices(f);
            const auto k = static_cast<double>(corners.size());
            n += area[static_cast<std::size_t>(f)];
            for (std::size_t c = 0; c < corners.size(); ++c) {
                L[corners[c]] -= area[static_cast<std::size_t>(f)].norm() / (k * m_[static_cast<std::size_t>(v)]) / k;
                const Vec3 edge = X[static_cast<std::size_t>(corners[(c + 1) % corners.size()])] -
                                  X[static_cast<std::size_t>(corners[c])];
                // (size of the slave along the edge / length of the edge)^2 = 1 / edge . metric edge; across a plane slave
                // there is no size
                if (const double inverse = edge.dot(metric * edge); inverse > 0)
                    ratio = std::min(ratio, 1 / std::sqrt(inverse));
            }
        }
        const double theta = std::clamp(2 * (1 - ratio), 0.0, 1.0);
        if (!(theta > 0)) continue;
        n.normalize();
        const Vec3 e1 = n.unitOrthogonal(), e2 = n.cross(e1);
        Vec3 mean = Vec3::Zero();
        for (const auto& [i, w] : L) mean += X[static_cast<std::size_t>(i)] / static_cast<double>(L.size());
        const auto in_plane = [&](Index i) -> Vec2 {
            const Vec3 r = X[static_cast<std::size_t>(i)] - mean;
            return {r.dot(e1), r.dot(e2)};
        };
        Mat2 second = Mat2::Zero();
        Vec2 off = Vec2::Zero();
        for (const auto& [i, w] : L) {
            const Vec2 t = in_plane(i);
            second += t * t.transpose();
            off += w * t;
        }
        const Vec2 slope = second.inverse() * off;
        Stencil& stencil = stencils_.emplace_back();
        stencil.scale = theta * m_[static_cast<std::size_t>(v)];
        stencil.entries.push_back({v, 0});
        for (auto& [i, w] : L) {
            w -= slope.dot(in_plane(i));
            if (i == v) continue;
            stencil.entries.push_back({i, w});
            stencil.entries[0].share -= w;
            stencil.height += w * n.dot(X[static_cast<std::size_t>(i)] - X[static_cast<std::size_t>(v)]);
        }
    }
    make_rows();
}

void MasterFilter::make_rows() {
    std::vector<std::map<Index, double>> Q(m_.size());
    for (std::size_t v = 0; v < Q.size(); ++v) Q[v][static_cast<Index>(v)] = 1;
    for (const Stencil& stencil : stencils_)
        for (const Entry& to : stencil.entries)
            for (const Entry& from : stencil.entries)
                Q[static_cast<std::size_t>(to.vertex)][from.vertex] -=
                    to.share * from.share * stencil.scale / m_[static_cast<std::size_t>(to.vertex)];
    row_start_.assign(1, 0);
    for (const auto& row : Q) {
        for (const auto& [i, q] : row) {
            columns_.push_back(i);
            Q_.push_back(q);
        }
        row_start_.push_back(columns_.size());
    }
    for (Stencil& stencil : stencils_)
        for (const Entry& to : stencil.entries) {
            const auto row = this->row(to.vertex);
            for (const Entry& from : stencil.entries)
                stencil.places.push_back(
                    row_start_[static_cast<std::size_t>(to.vertex)] +
                    static_cast<std::size_t>(std::ranges::lower_bound(row, from.vertex) - row.begin()));
        }
}

Vec3 MasterFilter::area_around(const Stencil& stencil, const std::vector<Vec3>& x, std::span<const Vec3> tails,
                               std::vector<Mat3>* derivatives) const {
    const auto v = static_cast<std::size_t>(stencil.entries[0].vertex);
    const auto from_v = [&](Index vertex) -> Vec3 {
        const auto i = static_cast<std::size_t>(vertex);
        return tails.empty() ? Vec3(x[i] - x[v]) : Vec3((x[i] - x[v]) + (tails[i] - tails[v]));
    };
    if (derivatives != nullptr) derivatives->assign(stencil.entries.size(), Mat3::Zero());
    Vec3 sum = Vec3::Zero();
    for (const Index f : surface_->vertex_facets(stencil.entries[0].vertex)) {
        const auto corners = surface_->facet_vertices(f);
        for (std::size_t c = 0; c < corners.size(); ++c) {
            const Vec3 next = from_v(corners[(c + 1) % corners.size()]);
            sum += from_v(corners[c]).cross(next) / 2;
            if (derivatives == nullptr) continue;
            const auto at = std::ranges::find(stencil.entries, corners[c], &Entry::vertex);
            const Vec3 across = from_v(corners[(c + corners.size() - 1) % corners.size()]) - next;
            (*derivatives)[static_cast<std::size_t>(at - stencil.entries.begin())] += cross_matrix(across) / 2;
        }
    }
    return sum;
}

void MasterFilter::apply(const std::vector<Vec3>& x, std::span<const Vec3> tails, std::vector<Vec3>& filtered,
                         std::vector<Vec3>& filtered_tails) const {
    std::vector<Vec3> change(x.size(), Vec3::Zero()); // m (x~ - x)
    for (const Stencil& stencil : stencils_) {
        const auto v = static_cast<std::size_t>(stencil.entries[0].vertex);
        Vec3 wave = -stencil.height * area_around(stencil, x, tails).normalized();
        for (const Entry& e : stencil.entries) {
            const auto i = static_cast<std::size_t>(e.vertex);
            wave += e.share * (x[i] - x[v]);
            if (!tails.empty()) wave += e.share * (tails[i] - tails[v]);
        }
        wave *= stencil.scale;
        for (const Entry& e : stencil.entries) change[static_cast<std::size_t>(e.vertex)] -= e.share * wave;
    }
    filtered.resize(x.size());
    filtered_tails.assign(tails.begin(), tails.end());
    for (std::size_t v = 0; v < x.size(); ++v) {
        const Vec3 lost = rounded_off(x[v], change[v] / m_[v], filtered[v]);
        if (!tails.empty()) filtered_tails[v] += lost;
    }
}

void MasterFilter::differentiate(const std::vector<Vec3>& x) {
    make_room();
    for (std::size_t k = 0; k < Q_.size(); ++k) derivatives_[k] = Q_[k] * Mat3::Identity();
    std::vector<Mat3> by;
    for (const Stencil& stencil : stencils_) {
        const Vec3 area = area_around(stencil, x, {}, &by);
        const double size = area.norm();
        const Vec3 n = area / size;
        // Theta m c dn
        const Mat3 turn = stencil.scale * stencil.height / size * (Mat3::Identity() - n * n.transpose());
        auto place = stencil.places.begin();
        for (const Entry& to : stencil.entries) {
            const Mat3 share = to.share / m_[static_cast<std::size_t>(to.vertex)] * turn;
            for (std::size_t from = 0; from < by.size(); ++from) derivatives_[*place++] += share * by[from];
        }
    }
}

} // namespace osculate::contact
