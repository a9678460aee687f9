#include "osculate/contact/past_end.hpp"

#include <algorithm>

namespace osculate::contact {
namespace {

/// A hit as if the surface did not end at its boundary.
FacetHit onto_facet(FacetHit hit) {
    hit.beyond = 0;
    return hit;
}

/// A hit of a point above the facet.
FacetHit onto_surface(FacetHit hit, double gap) {
    hit.beyond = hit.overhang = 0;
    hit.distance = std::abs(gap);
    return hit;
}

struct Edge {
    Vec3 begin = Vec3::Zero(), along = Vec3::Zero();
};
Edge edge_of(const std::vector<Vec3>& x, std::span<const Index> corners, int number) {
    const Vec3& a = x[corners[static_cast<std::size_t>(number)]];
    return {a, x[corners[static_cast<std::size_t>(number + 1) % corners.size()]] - a};
}

} // namespace

void PastEnd::evaluate(const Vec3& s, const FacetHit& hit, const PairPositions& at, Point& end,
                       ContactPoint& point) const {
    const auto corners = surface_->facet_vertices(hit.facet);
    point.found = point.behind = false;
    point.facet = hit.facet;
    point.trace.reset();
    end.hit = onto_facet(hit);
    facets_->evaluate(s, end.hit, at.vertices, end.facet);
    if (!end.facet.found) {
        point.behind = end.facet.behind;
        point.gap = end.facet.gap;
        return;
    }
    end.closest = at.search.closest_on(hit.facet, s, at.vertices);
    end.edge = end.corner = -1;
    end.beside = s;
    if (end.closest.overhang > 0) {
        double nearest = std::numeric_limits<double>::max();
        Vec3 c = s;
        for (int e = 0; e < static_cast<int>(corners.size()); ++e) {
            const Edge edge = edge_of(at.vertices, corners, e);
            if (edge.along.isZero(0)) continue;
            const double t = edge.along.dot(s - edge.begin) / edge.along.squaredNorm();
            const Vec3 on_edge = edge.begin + std::clamp(t, 0.0, 1.0) * edge.along;
            const double distance = (s - on_edge).norm();
            if (!(distance < nearest)) continue;
            nearest = distance;
            c = on_edge;
            end.fraction = t;
            end.edge = t > 0 && t < 1 ? e : -1;
            end.corner = t <= 0 ? e : t >= 1 ? (e + 1) % static_cast<int>(corners.size()) : -1;
        }
        end.beside = c + end.facet.gap * end.facet.normal;
    }
    at.master.evaluate(end.beside, onto_surface(end.closest, end.facet.gap), at.vertices, end.side);
    point.found = end.side.found;
    point.behind = end.side.behind;
    point.gap = end.side.gap;
    if (!point.found) return;
    point.side = end.side.side;
    point.normal = end.side.normal;
    point.foot = end.side.foot + (s - end.beside);
    point.nodes = end.side.nodes;
    end.place.clear();
    for (const Index v : end.facet.nodes) {
        const auto known = std::ranges::find(point.nodes, v);
        end.place.push_back(static_cast<Index>(known - point.nodes.begin()));
        if (known == point.nodes.end()) point.nodes.push_back(v);
    }
    const auto own = static_cast<Index>(end.side.nodes.size()), all = static_cast<Index>(point.nodes.size());
    point.weights = Vector::Zero(all);
    point.weights.head(own) = end.side.weights;
    point.pressing = MatrixX3::Zero(all, 3);
    point.pressing.topRows(own) = end.side.pressing;
}

void PastEnd::vary(const Vec3& s, const PairPositions& at, const Point& end, const ContactPoint& point,
                   ContactVariation& variation) const {
    const auto columns = 3 + 3 * static_cast<Index>(point.nodes.size());
    ContactVariation over_facet, of_side;
    over_facet.form = of_side.form = VariationForm::gap;
    facets_->vary(s, end.hit, at.vertices, end.facet, over_facet);
    at.master.vary(end.beside, onto_surface(end.closest, end.facet.gap), at.vertices, end.side, of_side);

    // ds' = dc + n_F dg_F + g_F dn_F
    Eigen::Matrix3Xd beside = Eigen::Matrix3Xd::Zero(3, columns);
    if (end.edge < 0 && end.corner < 0)
        beside.leftCols<3>().setIdentity();
    else {
        const auto column = [&](std::size_t k) { return 3 + 3 * end.place[k]; };
        const Eigen::Matrix3Xd up = end.facet.normal * over_facet.dg + end.facet.gap * over_facet.dn;
        beside.leftCols<3>() += up.leftCols<3>();
        for (std::size_t k = 0; k < end.place.size(); ++k)
            beside.middleCols<3>(column(k)) += up.middleCols<3>(3 + 3 * static_cast<Index>(k));
        if (end.corner >= 0)
            beside.middleCols<3>(column(static_cast<std::size_t>(end.corner))) += Mat3::Identity();
        else {
            // c = a + t L, t = (s - a) . L/L^2:  dt = (L . (ds - da) + (s - a - 2 t L) . dL)/L^2
            const auto corners = surface_->facet_vertices(end.closest.facet);
            const auto first = static_cast<std::size_t>(end.edge), second = (first + 1) % corners.size();
            const Edge edge = edge_of(at.vertices, corners, end.edge);
            const Vec3& L = edge.along;
            const double t = end.fraction, square = L.squaredNorm();
            const Vec3 by_L = (s - edge.begin - 2 * t * L) / square, by_s = L / square;
            beside.leftCols<3>() += L * by_s.transpose();
            beside.middleCols<3>(column(first)) += (1 - t) * Mat3::Identity() - L * (by_s + by_L).transpose();
            beside.middleCols<3>(column(second)) += t * Mat3::Identity() + L * by_L.transpose();
        }
    }
    variation.patches.clear();
    variation.dg = of_side.dg.leftCols<3>() * beside;
    variation.dn = of_side.dn.leftCols<3>() * beside;
    const auto own = 3 * static_cast<Index>(end.side.nodes.size());
    variation.dg.middleCols(3, own) += of_side.dg.middleCols(3, own);
    variation.dn.middleCols(3, own) += of_side.dn.middleCols(3, own);
}

} // namespace osculate::contact
