#include "contact/facet_rule.hpp"
#include "osculate/contact/mortar.hpp"
#include "osculate/core/parallel.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>

namespace osculate::contact {

void Mortar::prepare_variations(const PairPositions& at, std::span<const char> wanted, int threads) {
    parallel_for(threads, static_cast<Index>(facets_.size()), [&](Index begin, Index end) {
        for (Index f = begin; f < end; ++f) {
            Facet& facet = facets_[static_cast<std::size_t>(f)];
            if (std::none_of(facet.corners.begin(), facet.corners.end(),
                             [&](Index j) { return wanted[static_cast<std::size_t>(j)] != 0; }))
                continue;
            if (facet.gap_dual.usable) vary_gap(facet, at);
            if (facet.weight_dual.usable) vary_weights(facet, at);
        }
    });
}

void Mortar::vary_gap(Facet& facet, const PairPositions& at) const {
    const int n = facet.corners.count;
    facet.gap_vertices.clear();
    for (const GapPoint& q : facet.gap_points)
        if (q.point.found)
            facet.gap_vertices.insert(facet.gap_vertices.end(), q.point.nodes.begin(), q.point.nodes.end());
    sort_unique(facet.gap_vertices);
    const auto slaves = static_cast<Index>(facet.gap_slaves.size());
    const Index columns = 3 * (slaves + static_cast<Index>(facet.gap_vertices.size()));
    facet.dgap.setZero(n, columns);
    facet.dnormal.setZero(3 * n, columns);
    static thread_local ContactVariation variation;
    variation.form = VariationForm::gap;
    for (const GapPoint& q : facet.gap_points) {
        if (!q.point.found) continue;
        at.master.vary(position(q, at.slaves), q.hit, at.vertices, q.point, variation);
        const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4, 1> psi = q.weight * (facet.gap_dual.A * q.N.head(n));
        const auto add = [&](Index to, const Eigen::RowVector3d& dg, const Mat3& dn) {
            for (int c = 0; c < n; ++c) {
                facet.dgap.block<1, 3>(c, to) += psi(c) * dg;
                facet.dnormal.block<3, 3>(3 * c, to) += psi(c) * dn;
            }
        };
        for (const Share& share : q.shares)
            add(3 * place_in(facet.gap_slaves, share.slave), variation.dg.leftCols<3>() * share.C,
                variation.dn.leftCols<3>() * share.C);
        for (std::size_t i = 0; i < q.point.nodes.size(); ++i) {
            const Index from = 3 + 3 * static_cast<Index>(i);
            add(3 * (slaves + place_in(facet.gap_vertices, q.point.nodes[i])), variation.dg.middleCols<3>(from),
                variation.dn.middleCols<3>(from));
        }
    }
}

void Mortar::vary_weights(Facet& facet, const PairPositions& positions) const {
    // at fixed xi, along the slave plane's normal d:  X(u) = s + t d
    //     du_a = b^a . (ds - N_i dx_i + t dd),   b^a . X,b = delta_ab,  b^a . d = 0,   dd = (I - d d^T) dA / |A|
    // what moves with the borders of the overlaps cancels, since N_i runs on across them
    const int n = facet.corners.count;
    facet.weight_vertices.clear();
    for (const Overlap& overlap : facet.overlaps) {
        const auto v = surface_.facet_vertices(overlap.facet);
        facet.weight_vertices.insert(facet.weight_vertices.end(), v.begin(), v.end());
    }
    sort_unique(facet.weight_vertices);
    const auto count = static_cast<Index>(facet.weight_vertices.size());
    facet.dweights.setZero(n * count, 3 * (n + count));
    const std::vector<Vec3>& x = positions.vertices;
    const std::vector<Vec3> corner = corners(facet, positions.slaves);
    const SlavePlane plane(corner);
    const Vec3& d = plane.normal();
    // d(2A) of each corner, as the vector e of  dA = e x dx
    std::array<Vec3, 4> edge{};
    for (int c = 0; c < n; ++c) {
        const auto at = [&](int k) { return corner[static_cast<std::size_t>((c + k) % n)]; };
        edge[static_cast<std::size_t>(c)] = (at(n - 1) - at(1)) / 2;
    }
    for (const Overlap& overlap : facet.overlaps) {
        const auto vertices = surface_.facet_vertices(overlap.facet);
        const auto m = static_cast<Index>(vertices.size());
        std::array<Index, 4> place{};
        for (Index i = 0; i < m; ++i)
            place[static_cast<std::size_t>(i)] = place_in(facet.weight_vertices, vertices[static_cast<std::size_t>(i)]);
        for (const OverlapPoint& q : overlap.points) {
            const Shape slave = shape(n, q.xi), master = shape(static_cast<int>(m), q.u);
            Vec3 X = Vec3::Zero(), at = Vec3::Zero();
            Mat3 frame; // X,1  X,2  d
            frame.setZero();
            frame.col(2) = d;
            for (Index i = 0; i < m; ++i) {
                const Vec3& xi = x[static_cast<std::size_t>(vertices[static_cast<std::size_t>(i)])];
                X += master.N(i) * xi;
                frame.leftCols<2>() += xi * master.N_a.row(i);
            }
            for (int c = 0; c < n; ++c) at += slave.N(c) * corner[static_cast<std::size_t>(c)];
            const double t = d.dot(X - at);
            const Eigen::Matrix<double, 2, 3> b = frame.inverse().topRows<2>();
            const Eigen::Matrix<double, 4, 3> by_s = master.N_a * b; // dN_i / ds
            const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4, 1> psi =
                q.area * (facet.weight_dual.A * slave.N.head(n));
            for (Index i = 0; i < m; ++i) {
                const Eigen::RowVector3d row = by_s.row(i);
                const auto add = [&](Index column, const Eigen::RowVector3d& value) {
                    for (int c = 0; c < n; ++c)
                        facet.dweights.block<1, 3>(c * count + place[static_cast<std::size_t>(i)], column) +=
                            psi(c) * value;
                };
                for (int c = 0; c < n; ++c) {
                    // row . t (e x dx) / |A|
                    const Vec3 turn = t / plane.area() * Vec3(row.transpose()).cross(edge[static_cast<std::size_t>(c)]);
                    add(3 * c, slave.N(c) * row + turn.transpose());
                }
                for (Index k = 0; k < m; ++k) add(3 * (n + place[static_cast<std::size_t>(k)]), -master.N(k) * row);
            }
        }
    }
}

void Mortar::vary(Index j, const PairPositions&, const FacetHit&, const ContactPoint& point,
                  ContactVariation& variation) const {
    const Index carried = carriers(j, point);
    const auto columns = 3 + 3 * static_cast<Index>(point.nodes.size());
    variation.dg.setZero(columns);
    variation.dn.setZero(3, columns);
    variation.dweights.setZero(carried, columns);
    const double by_gap = gap_area(j), by_weight = weight_area(j);
    // nodes: carriers ascending, then the rest of the vertices ascending, then slaves ascending
    const auto first = point.nodes.begin(), last_carrier = first + carried;
    const auto column = [&](Index node) -> Index {
        const auto early = std::lower_bound(first, last_carrier, node);
        if (early != last_carrier && *early == node) return 3 + 3 * static_cast<Index>(early - first);
        return 3 + 3 * static_cast<Index>(std::lower_bound(last_carrier, point.nodes.end(), node) - first);
    };
    for (const auto& [f, c] : incident_[static_cast<std::size_t>(j)]) {
        const Facet& facet = facets_[static_cast<std::size_t>(f)];
        const auto of_slave = [&](Index slave) { return slave == j ? 0 : column(surface_.vertex_count() + slave); };
        const auto each = [&](std::span<const Index> slaves, const std::vector<Index>& vertices, auto&& add) {
            Index from = 0;
            for (const Index slave : slaves) {
                add(of_slave(slave), from);
                from += 3;
            }
            for (const Index v : vertices) {
                add(column(v), from);
                from += 3;
            }
        };
        const int corner = c;
        if (facet.gap_dual.usable)
            each(facet.gap_slaves, facet.gap_vertices, [&](Index to, Index from) {
                variation.dg.middleCols<3>(to) += facet.dgap.block<1, 3>(corner, from) / by_gap;
                variation.dn.middleCols<3>(to) += facet.dnormal.block<3, 3>(3 * corner, from) / by_gap;
            });
        if (!facet.weight_dual.usable) continue;
        const auto count = static_cast<Index>(facet.weight_vertices.size());
        std::vector<Index> row;
        for (const Index v : facet.weight_vertices) row.push_back((column(v) - 3) / 3);
        each({facet.corners.begin(), facet.corners.end()}, facet.weight_vertices, [&](Index to, Index from) {
            for (Index i = 0; i < count; ++i)
                variation.dweights.block<1, 3>(row[static_cast<std::size_t>(i)], to) +=
                    facet.dweights.block<1, 3>(corner * count + i, from) / by_weight;
        });
    }
    const Vec3& normal = point.normal;
    Mat3 turn = (Mat3::Identity() - normal * normal.transpose()) / normal_length_[static_cast<std::size_t>(j)];
    if (!in_plane_.empty()) turn = turn * in_plane_[static_cast<std::size_t>(j)];
    variation.dn = (turn * variation.dn).eval();
}

} // namespace osculate::contact
