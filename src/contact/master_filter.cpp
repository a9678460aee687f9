#include "osculate/contact/master_filter.hpp"

#include "contact/area_vector.hpp"
#include "osculate/core/rounded_sum.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
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

MasterFilter::MasterFilter(const mesh::HalfEdgeSurface& surface, std::vector<Vec3> X, const Mat3& metric)
    : surface_(&surface), X_(std::move(X)), m_(X_.size(), 0.0) {
    std::vector<Vec3> area(static_cast<std::size_t>(surface.facet_count()));
    for (Index f = 0; f < surface.facet_count(); ++f) {
        const auto corners = surface.facet_vertices(f);
        area[static_cast<std::size_t>(f)] = area_vector(corners, X_);
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
                const Vec3 edge = X_[static_cast<std::size_t>(corners[(c + 1) % corners.size()])] -
                                  X_[static_cast<std::size_t>(corners[c])];
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
        for (const auto& [i, w] : L) mean += X_[static_cast<std::size_t>(i)] / static_cast<double>(L.size());
        const auto in_plane = [&](Index i) -> Vec2 {
            const Vec3 r = X_[static_cast<std::size_t>(i)] - mean;
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
        Stencil stencil;
        stencil.vertex = v;
        stencil.scale = theta * m_[static_cast<std::size_t>(v)];
        for (auto& [i, w] : L) {
            w -= slope.dot(in_plane(i));
            if (i == v) continue;
            stencil.entries.push_back({i, w});
            stencil.reference += w * (X_[static_cast<std::size_t>(i)] - X_[static_cast<std::size_t>(v)]);
        }
        stencil.turned = stencil.reference;
        stencils_.push_back(std::move(stencil));
    }
    make_rows();
}

void MasterFilter::make_rows() {
    std::vector<std::map<Index, double>> Q(X_.size());
    for (std::size_t v = 0; v < Q.size(); ++v) Q[v][static_cast<Index>(v)] = 1;
    for (const Stencil& stencil : stencils_) {
        std::vector<Entry> L = stencil.entries;
        double own = 0;
        for (const Entry& e : L) own -= e.share;
        L.push_back({stencil.vertex, own});
        for (const Entry& to : L)
            for (const Entry& from : L)
                Q[static_cast<std::size_t>(to.vertex)][from.vertex] -=
                    to.share * from.share * stencil.scale / m_[static_cast<std::size_t>(to.vertex)];
    }
    row_start_.assign(1, 0);
    for (const auto& row : Q) {
        for (const auto& [i, q] : row) rows_.push_back({i, q});
        row_start_.push_back(rows_.size());
    }
}

Vec3 MasterFilter::normal(const Stencil& stencil, const std::vector<Vec3>& x) const {
    Vec3 n = Vec3::Zero();
    for (const Index f : surface_->vertex_facets(stencil.vertex)) n += area_vector(surface_->facet_vertices(f), x);
    return n;
}

void MasterFilter::begin(const std::vector<Vec3>& x) {
    for (Stencil& stencil : stencils_) {
        const auto v = static_cast<std::size_t>(stencil.vertex);
        // the rotation nearest to the deformation of the facets around the vertex, with their area vectors
        const Vec3 N = normal(stencil, X_), n = normal(stencil, x);
        Mat3 F = n * N.transpose() / N.norm();
        for (const Entry& e : stencil.entries) {
            const auto i = static_cast<std::size_t>(e.vertex);
            F += (x[i] - x[v]) * (X_[i] - X_[v]).transpose();
        }
        const Eigen::JacobiSVD<Mat3> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
        Mat3 turn = svd.matrixU() * svd.matrixV().transpose();
        if (turn.determinant() < 0) {
            Mat3 U = svd.matrixU();
            U.col(2) *= -1;
            turn = U * svd.matrixV().transpose();
        }
        stencil.turned = turn * stencil.reference;
    }
}

void MasterFilter::apply(const std::vector<Vec3>& x, std::span<const Vec3> tails, std::vector<Vec3>& filtered,
                         std::vector<Vec3>& filtered_tails) const {
    std::vector<Vec3> change(x.size(), Vec3::Zero()); // m (x~ - x)
    for (const Stencil& stencil : stencils_) {
        const auto v = static_cast<std::size_t>(stencil.vertex);
        Vec3 wave = -stencil.turned;
        for (const Entry& e : stencil.entries) {
            const auto i = static_cast<std::size_t>(e.vertex);
            wave += e.share * (x[i] - x[v]);
            if (!tails.empty()) wave += e.share * (tails[i] - tails[v]);
        }
        wave *= stencil.scale;
        for (const Entry& e : stencil.entries) {
            change[static_cast<std::size_t>(e.vertex)] -= e.share * wave;
            change[v] += e.share * wave;
        }
    }
    filtered.resize(x.size());
    filtered_tails.assign(tails.begin(), tails.end());
    for (std::size_t v = 0; v < x.size(); ++v) {
        const Vec3 lost = rounded_off(x[v], change[v] / m_[v], filtered[v]);
        if (!tails.empty()) filtered_tails[v] += lost;
    }
}

} // namespace osculate::contact
