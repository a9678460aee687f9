#include "contact/facet_rule.hpp"
#include "osculate/contact/mortar.hpp"
#include "osculate/core/parallel.hpp"

#include <algorithm>

namespace osculate::contact {

void Mortar::prepare_variations(const PairPositions& at, std::span<const char> wanted, int threads) {
    parallel_for(threads, static_cast<Index>(facets_.size()), [&](Index begin, Index end) {
        for (Index f = begin; f < end; ++f) {
            Facet& facet = facets_[static_cast<std::size_t>(f)];
            if (std::none_of(facet.corners.begin(), facet.corners.end(),
                             [&](Index j) { return wanted[static_cast<std::size_t>(j)] != 0; }))
                continue;
            if (facet.dual.usable) vary_gap(facet, at);
            weights_.vary(f, at);
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
        const Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 4, 1> psi = q.weight * (facet.dual.A * q.N.head(n));
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

void Mortar::vary(Index j, const PairPositions&, const FacetHit&, const ContactPoint& point,
                  ContactVariation& variation) const {
    const Index carried = carriers(j, point);
    const auto columns = 3 + 3 * static_cast<Index>(point.nodes.size());
    variation.dg.setZero(columns);
    variation.dn.setZero(3, columns);
    variation.dweights.setZero(carried, columns);
    const double by_gap = gap_area(j);
    // nodes: carriers ascending, then the rest of the vertices ascending, then slaves ascending
    const auto first = point.nodes.begin(), last_carrier = first + carried;
    const auto column = [&](Index node) -> Index {
        const auto early = std::lower_bound(first, last_carrier, node);
        if (early != last_carrier && *early == node) return 3 + 3 * static_cast<Index>(early - first);
        return 3 + 3 * static_cast<Index>(std::lower_bound(last_carrier, point.nodes.end(), node) - first);
    };
    const auto of_slave = [&](Index slave) { return slave == j ? 0 : column(surface_.vertex_count() + slave); };
    for (const auto& [f, c] : weights_.around(j)) {
        const Facet& facet = facets_[static_cast<std::size_t>(f)];
        if (!facet.dual.usable) continue;
        const int corner = c;
        Index from = 0;
        const auto add = [&](Index to) {
            variation.dg.middleCols<3>(to) += facet.dgap.block<1, 3>(corner, from) / by_gap;
            variation.dn.middleCols<3>(to) += facet.dnormal.block<3, 3>(3 * corner, from) / by_gap;
            from += 3;
        };
        for (const Index slave : facet.gap_slaves) add(of_slave(slave));
        for (const Index v : facet.gap_vertices) add(column(v));
    }
    weights_.add_variations(
        j, point.weights, [&](Index v) { return (column(v) - 3) / 3; }, of_slave, column, variation.dweights);
    const Vec3& normal = point.normal;
    Mat3 turn = (Mat3::Identity() - normal * normal.transpose()) / normal_length_[static_cast<std::size_t>(j)];
    if (!in_plane_.empty()) turn = turn * in_plane_[static_cast<std::size_t>(j)];
    variation.dn = (turn * variation.dn).eval();
}

} // namespace osculate::contact
