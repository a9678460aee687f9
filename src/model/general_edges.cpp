/// General contact of edges that cross edges.

#include "osculate/contact/near_facets.hpp"
#include "osculate/model/general_contact.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>

namespace osculate::model {

namespace {
/// Sine of the angle between facets from which their edge may meet a sharp edge: of coarse round bodies, whose smooth surfaces
/// sharp edges enter between the nodes of both. And from which it may meet any other where one of them is watched.
constexpr double blunt = 0.35, convex = 0.05;
/// Angle by which a body may turn before pairs are looked for anew, rad: its nodes move no farther than the margin then.
double turn(double margin, double diagonal) {
    return 2 * std::asin(std::min(1.0, margin / diagonal));
}
} // namespace

void GeneralContact::find_convex_edges() {
    sharp_.assign(X_.size(), 0);
    for (std::size_t s = 0; s < surfaces_.size(); ++s) {
        const MasterSide& side = *surfaces_[s].side;
        const mesh::HalfEdgeSurface& surface = side.surface();
        const std::vector<Vec3> x = side.vertices(X_);
        for (Index h = 0; h < static_cast<Index>(surface.half_edges().size()); ++h) {
            const mesh::HalfEdge& half = surface.half_edges()[h];
            if (half.twin < h) continue; // also those at a boundary
            const auto [a, b] = contact::vertices_of_edge(surface, h);
            const contact::SharpEdge edge = contact::sharp_edge(surface, h, x);
            const auto around = surface.facet_vertices(half.facet);
            Vec3 normal = Vec3::Zero();
            for (std::size_t c = 2; c < around.size(); ++c)
                normal += (x[around[c - 1]] - x[around[0]]).cross(x[around[c]] - x[around[0]]);
            const bool sharp = surface.is_feature_edge(h);
            if (!(normal.normalized().dot(edge.wings[1]) < (sharp ? 0 : -convex))) continue; // hollow, or flat
            const bool blunt_enough = sharp || normal.normalized().dot(edge.wings[1]) < -blunt;
            const auto count = static_cast<Index>(surfaces_[s].facets.size());
            const auto [f, g] = contact::facets_at_edge(surface, h);
            const bool own = f < count && g < count;
            convex_edges_.push_back({static_cast<Index>(s), h, own, sharp, blunt_enough});
            if (sharp) sharp_[side.nodes()[a]] = sharp_[side.nodes()[b]] = 1;
        }
    }
}

void GeneralContact::add_edges(const ContactScope& scope, const std::vector<ContactHistory>& before,
                               std::vector<ContactHistory>& histories) const {
    std::vector<std::vector<Vec3>> vertices;
    for (const OuterSurface& surface : surfaces_) vertices.push_back(surface.side->vertices(scope.x));
    std::vector<contact::SharpEdge> at;
    std::vector<mesh::Facet> ends;
    std::vector<Index> surface;
    std::vector<double> margin;
    std::vector<Vec3> x;
    for (const ConvexEdge& edge : convex_edges_) {
        const auto s = static_cast<std::size_t>(edge.surface);
        at.push_back(contact::sharp_edge(surfaces_[s].side->surface(), edge.half_edge, vertices[s]));
        mesh::Facet& both = ends.emplace_back();
        both.count = 2;
        for (std::size_t k = 0; k < 2; ++k) {
            both.nodes[k] = static_cast<Index>(x.size());
            x.push_back(at.back().end[k]);
        }
        surface.push_back(edge.surface);
        margin.push_back(scope.margin[s]);
    }
    const auto meet = [&](Index a, Index b) {
        return a != b && left_out_[static_cast<std::size_t>(a) * surfaces_.size() + static_cast<std::size_t>(b)] == 0;
    };
    const auto are_watched = [&](const ConvexEdge& one, const ConvexEdge& other) {
        return is_watched(scope.watched, one, other.surface) || is_watched(scope.watched, other, one.surface);
    };
    const auto may_cross = [&](Index e, Index f) {
        const ConvexEdge &one = convex_edges_[static_cast<std::size_t>(e)],
                         &other = convex_edges_[static_cast<std::size_t>(f)];
        if (!(one.own || other.own)) return false;
        if (!((one.sharp && other.blunt) || (one.blunt && other.sharp) || are_watched(one, other))) return false;
        const auto a = static_cast<std::size_t>(one.surface), b = static_cast<std::size_t>(other.surface);
        const contact::SharpEdge &p = at[static_cast<std::size_t>(e)], &q = at[static_cast<std::size_t>(f)];
        const contact::LineCrossing crossing = contact::cross_lines(p.end[0], p.end[1], q.end[0], q.end[1]);
        if (!(crossing.sine > contact::least_sine)) return false;
        const double turned = turn(scope.margin[a], diagonal_[a]) + turn(scope.margin[b], diagonal_[b]),
                     tolerance = are_watched(one, other) ? contact::watched_tolerance : contact::cone_tolerance,
                     allowed = std::sin(std::min(0.5 * std::numbers::pi, turned + std::asin(tolerance)));
        return std::min(contact::out_of_cones(crossing.across, p, q), contact::out_of_cones(-crossing.across, p, q)) <=
               allowed;
    };
    std::map<std::pair<Index, Index>, std::vector<std::array<Index, 2>>> found;
    const auto add = [&](const ConvexEdge& slave, const ConvexEdge& master) {
        if (!slave.own) return;
        const mesh::HalfEdgeSurface &own = surfaces_[static_cast<std::size_t>(slave.surface)].side->surface(),
                                    &other = surfaces_[static_cast<std::size_t>(master.surface)].side->surface();
        for (const Index f : contact::facets_at_edge(own, slave.half_edge))
            for (const Index g : contact::facets_at_edge(other, master.half_edge))
                if (g < static_cast<Index>(surfaces_[static_cast<std::size_t>(master.surface)].facets.size()) &&
                    !may_meet(first_[static_cast<std::size_t>(slave.surface)] + f,
                              first_[static_cast<std::size_t>(master.surface)] + g))
                    return;
        auto& list = found[{slave.surface, master.surface}];
        list.push_back({slave.half_edge, master.half_edge});
        list.push_back({own.half_edges()[static_cast<std::size_t>(slave.half_edge)].twin, master.half_edge});
    };
    for (const auto& [e, f] : contact::near_facets(ends, surface, margin, x, meet, may_cross)) {
        const ConvexEdge &one = convex_edges_[static_cast<std::size_t>(e)],
                         &other = convex_edges_[static_cast<std::size_t>(f)];
        const double E = surfaces_[static_cast<std::size_t>(one.surface)].E,
                     E_other = surfaces_[static_cast<std::size_t>(other.surface)].E;
        const bool first = E != E_other ? E < E_other : one.surface < other.surface; // the softer is the slave
        add(first ? one : other, first ? other : one);
    }
    for (auto& entry : found) {
        const std::pair<Index, Index>& sides = entry.first;
        auto& edges = entry.second;
        std::ranges::sort(edges);
        ContactHistory& history = histories.emplace_back(opened(make_edges(scope, sides.first, sides.second, edges)));
        const auto old = std::ranges::find_if(before, [&](const ContactHistory& one) {
            return one.pair->slaves().edges && sides_of(*one.pair) == sides;
        });
        if (old == before.end()) continue;
        history.master = old->master;
        if (!old->slides.empty()) history.slides.assign(history.status.size(), 0);
        const std::vector<std::array<Index, 2>>& known = old->pair->slaves().edges->half_edges;
        for (std::size_t j = 0; j < edges.size(); ++j) {
            const auto known_at = std::ranges::lower_bound(known, edges[j]);
            if (known_at == known.end() || *known_at != edges[j]) continue;
            const auto k = static_cast<std::size_t>(known_at - known.begin());
            history.lambda[j] = old->lambda[k];
            history.status[j] = old->status[k];
            history.facet[j] = old->facet[k];
            if (!history.slides.empty()) history.slides[j] = old->slides[k];
        }
    }
}

std::shared_ptr<const ContactPair> GeneralContact::make_edges(const ContactScope& scope, Index slave, Index master,
                                                              const std::vector<std::array<Index, 2>>& edges) const {
    const OuterSurface &own = surfaces_[static_cast<std::size_t>(slave)],
                       &other = surfaces_[static_cast<std::size_t>(master)];
    const mesh::HalfEdgeSurface& surface = own.side->surface();
    const std::vector<Index>& nodes = own.side->nodes();
    const double E = std::min(own.E, other.E);
    SlaveNodes slaves;
    CrossingEdges& crossing = slaves.edges.emplace();
    crossing.half_edges = edges;
    std::map<Index, Index> others; // numbers of further nodes
    const auto number_of = [&](Index vertex) {
        const auto [at, fresh] = others.try_emplace(nodes[static_cast<std::size_t>(vertex)],
                                                    static_cast<Index>(edges.size() + others.size()));
        if (fresh) crossing.others.push_back(at->first);
        return at->second;
    };
    for (const auto& [half_edge, meets] : edges) {
        const auto [a, b] = contact::vertices_of_edge(surface, half_edge);
        const double length = (X_[static_cast<std::size_t>(nodes[static_cast<std::size_t>(b)])] -
                               X_[static_cast<std::size_t>(nodes[static_cast<std::size_t>(a)])])
                                  .norm();
        slaves.node.push_back(nodes[static_cast<std::size_t>(a)]);
        slaves.area.push_back(0); // a point
        slaves.stiffness.push_back(options_.stiffness_scale * E * length);
        contact::EdgesThatMeet& one = crossing.meet.emplace_back();
        one.end = number_of(b);
        one.half_edge = meets;
        one.watched =
            is_watched(scope.watched, {slave, half_edge}, master) || is_watched(scope.watched, {master, meets}, slave);
        const std::array<Index, 2> reverse{surface.half_edges()[static_cast<std::size_t>(half_edge)].twin, meets};
        one.reverse = static_cast<Index>(std::ranges::lower_bound(edges, reverse) - edges.begin());
        for (std::size_t k = 0; k < 2; ++k) {
            one.wings[k] = {-1, -1, -1, -1};
            std::size_t c = 0;
            for (const Index v : surface.facet_vertices(contact::facets_at_edge(surface, half_edge)[k]))
                one.wings[k][c++] = number_of(v);
        }
    }
    ContactOptions options = options_.pair;
    options.friction = options_.friction(slave, master);
    if (options_.static_friction.size() > 0) options.static_friction = options_.static_friction(slave, master);
    options.discretisation = Discretisation::node;
    return std::make_shared<const ContactPair>("general: edges of " + own.name + " on " + other.name, X_,
                                               std::move(slaves), other.side, options);
}

} // namespace osculate::model
