/// Where general contact looks for pairs, which facets are near each other there, and how long these are all.

#include "osculate/contact/near_facets.hpp"
#include "osculate/model/general_contact.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

namespace osculate::model {

namespace {
/// Behind this part of the thickness of the body a facet's front ends.
constexpr double into_thickness = 0.15;
/// How far a surface may move against itself, in mean facet sizes, before pairs within it are looked for anew.
constexpr double own_sizes = 1.5;
/// How far a surface may move, in mean facet sizes and in diagonals of its box, before pairs are looked for anew.
constexpr double sizes = 1, diagonals = 0.05;

Vec3 centre_of(const mesh::Facet& facet, const std::vector<Vec3>& x) {
    Vec3 sum = Vec3::Zero();
    for (const Index node : facet) sum += x[node];
    return sum / facet.count;
}
} // namespace

ContactScope GeneralContact::scope_at(const Field& x, double expected, std::vector<WatchedNode> watched) const {
    ContactScope scope{x, {}, {}, std::move(watched)};
    for (const OuterSurface& surface : surfaces_) {
        const double size = surface.side->surface().mean_facet_size(), diagonal = diagonal_[scope.margin.size()];
        scope.margin.push_back(std::max({sizes * size, diagonals * diagonal, 2 * expected}));
        scope.own.push_back(std::max(own_sizes * size, 2 * expected));
    }
    return scope;
}

bool GeneralContact::covers(const ContactScope& scope, const Field& x, double ahead) const {
    std::vector<Vec3> mean(surfaces_.size(), Vec3::Zero());
    std::vector<double> nodes(surfaces_.size(), 0);
    for (std::size_t node = 0; node < surface_of_.size(); ++node)
        if (surface_of_[node] >= 0) {
            mean[static_cast<std::size_t>(surface_of_[node])] += x[node] - scope.x[node];
            ++nodes[static_cast<std::size_t>(surface_of_[node])];
        }
    for (std::size_t node = 0; node < surface_of_.size(); ++node) {
        if (surface_of_[node] < 0) continue;
        const auto s = static_cast<std::size_t>(surface_of_[node]);
        const Vec3 moved = x[node] - scope.x[node];
        if (!(moved.norm() + ahead <= scope.margin[s])) return false;
        if (left_out_[s * surfaces_.size() + s] == 0 && !((moved - mean[s] / nodes[s]).norm() + ahead <= scope.own[s]))
            return false;
    }
    return true;
}

GeneralContact::FacetPlaces GeneralContact::places(const std::vector<Vec3>& x) const {
    FacetPlaces at;
    for (const mesh::Facet& facet : facets_) {
        at.normal.push_back(mesh::facet_area_vector(facet, x).normalized());
        at.centre.push_back(centre_of(facet, x));
        double farthest = 0;
        for (const Index node : facet) farthest = std::max(farthest, (x[node] - at.centre.back()).norm());
        at.radius.push_back(farthest);
    }
    return at;
}

double GeneralContact::missing(Index f, Index g, const Vec3& normal, const Vec3& centre,
                               const std::vector<Vec3>& x) const {
    double farthest = -std::numeric_limits<double>::max();
    for (const Index node : facets_[f]) farthest = std::max(farthest, normal.dot(x[node] - centre));
    return -farthest - behind * std::min(data_[f].size, data_[g].size);
}

GeneralContact::FacetPairs GeneralContact::near_pairs(const ContactScope& scope, const FacetPlaces& at) const {
    const std::vector<Vec3>& x = scope.x;
    const auto& [normal, centre, radius] = at;
    const auto in_front_of = [&, &normal = normal, &centre = centre](Index f, Index g, double depth) {
        return std::ranges::any_of(facets_[f], [&](Index node) { return normal[g].dot(x[node] - centre[g]) > -depth; });
    };
    // facets of one surface may have the body between them
    const auto within = [&, &centre = centre, &radius = radius](Index f, Index g) {
        const auto s = static_cast<std::size_t>(data_[f].surface);
        if ((centre[f] - centre[g]).norm() > 2 * scope.own[s] + radius[f] + radius[g]) return false;
        const auto depth = [&](Index facet) {
            return into_thickness * std::min(data_[facet].size, surfaces_[s].side->thickness(facet - first_[s]));
        };
        return in_front_of(f, g, depth(g)) && in_front_of(g, f, depth(f)) && may_meet(f, g);
    };
    std::vector<Index> surface;
    std::vector<double> margin, own;
    std::vector<double> widest(surfaces_.size(), 0);
    for (std::size_t f = 0; f < data_.size(); ++f)
        widest[data_[f].surface] = std::max(widest[data_[f].surface], at.radius[f]);
    for (const Facet& facet : data_) {
        const auto s = static_cast<std::size_t>(facet.surface);
        surface.push_back(facet.surface);
        margin.push_back(scope.margin[s]);
        own.push_back(std::min(scope.margin[s], scope.own[s] + widest[s])); // no less than within() wants
    }
    const auto meet = [&](Index a, Index b) {
        return left_out_[static_cast<std::size_t>(a) * surfaces_.size() + static_cast<std::size_t>(b)] == 0;
    };
    FacetPairs near = contact::near_facets(
        facets_, surface, margin, x, [&](Index a, Index b) { return a != b && meet(a, b); },
        [&](Index f, Index g) { return may_meet(f, g); });
    const FacetPairs of_one = contact::near_facets(
        facets_, surface, own, x, [&](Index a, Index b) { return a == b && meet(a, b); }, within);
    near.insert(near.end(), of_one.begin(), of_one.end());
    std::ranges::sort(near);
    return near;
}

std::vector<PassedFacets> GeneralContact::passed(const ContactScope& scope, const FacetPlaces& at,
                                                 const FacetPairs& near) const {
    const auto& [normal, centre, radius] = at;
    std::vector<PassedFacets> list;
    for (const auto& [f, g] : near) {
        const auto a = static_cast<std::size_t>(data_[f].surface), b = static_cast<std::size_t>(data_[g].surface);
        if (a == b || !(normal[f].dot(normal[g]) < contact::facing)) continue;
        const double between = (centre[f] - centre[g]).norm() - radius[f] - radius[g];
        if (between > scope.margin[a] + scope.margin[b]) continue; // moves no nearer within the scope
        if (missing(f, g, normal[g], centre[g], scope.x) > 0 || missing(g, f, normal[f], centre[f], scope.x) > 0)
            list.push_back({between, f, g});
    }
    std::ranges::sort(list);
    return list;
}

std::vector<PassedFacets> GeneralContact::passed(const ContactScope& scope) const {
    const FacetPlaces at = places(scope.x);
    return passed(scope, at, near_pairs(scope, at));
}

std::vector<Index> GeneralContact::reachable(const ContactScope& scope, const ContactPair& pair) const {
    const auto [slave, master] = sides_of(pair);
    const auto a = static_cast<std::size_t>(slave), b = static_cast<std::size_t>(master);
    const double reach = a == b ? 2 * scope.own[a] : scope.margin[a] + scope.margin[b];
    const std::vector<Vec3> vertices = pair.vertices(scope.x);
    Eigen::AlignedBox3d slaves;
    for (const Index node : pair.slaves().node) slaves.extend(scope.x[node]);
    std::vector<char> reached(vertices.size(), 0);
    const mesh::HalfEdgeSurface& surface = pair.surface();
    for (Index f = 0; f < surface.facet_count(); ++f) {
        Eigen::AlignedBox3d box;
        for (const Index v : surface.facet_vertices(f)) box.extend(vertices[v]);
        box.min().array() -= reach;
        box.max().array() += reach;
        if (!box.intersects(slaves) ||
            std::ranges::none_of(pair.slaves().node, [&](Index node) { return box.contains(scope.x[node]); }))
            continue;
        for (const Index v : pair.master()->patch_vertices(f)) reached[v] = 1;
    }
    std::vector<Index> nodes;
    for (std::size_t v = 0; v < reached.size(); ++v)
        if (reached[v] != 0) nodes.push_back(pair.node(static_cast<Index>(v)));
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
}

bool GeneralContact::alike(const ContactPair& one, const ContactPair& other) {
    const SlaveNodes &a = one.slaves(), &b = other.slaves();
    const auto same_facet = [](const mesh::Facet& f, const mesh::Facet& g) { return f.nodes == g.nodes; };
    const auto same_edges = [](const contact::EdgesThatMeet& e, const contact::EdgesThatMeet& f) {
        return e.half_edge == f.half_edge && e.watched == f.watched;
    };
    if (&one.master_side() != &other.master_side() || a.node != b.node || a.yields != b.yields ||
        a.watched != b.watched || !std::ranges::equal(a.facets, b.facets, same_facet) ||
        a.own.has_value() != b.own.has_value() || a.edges.has_value() != b.edges.has_value())
        return false;
    if (a.own && a.own->reach != b.own->reach) return false;
    return !a.edges ||
           (a.edges->half_edges == b.edges->half_edges && std::ranges::equal(a.edges->meet, b.edges->meet, same_edges));
}

bool GeneralContact::comes_round(const ContactScope& scope, const Field& x, double ahead) const {
    if (scope.passed.empty()) return false;
    std::vector<double> moved(surfaces_.size(), ahead);
    for (std::size_t node = 0; node < surface_of_.size(); ++node)
        if (surface_of_[node] >= 0) {
            double& largest = moved[static_cast<std::size_t>(surface_of_[node])];
            largest = std::max(largest, (x[node] - scope.x[node]).norm() + ahead);
        }
    const double farthest = 2 * std::ranges::max(moved);
    for (const auto& [between, f, g] : scope.passed) {
        if (between > farthest) return false;
        if (between >
            moved[static_cast<std::size_t>(data_[f].surface)] + moved[static_cast<std::size_t>(data_[g].surface)])
            continue; // too far from each other to touch
        const auto behind_of = [&](Index one, Index other) {
            return missing(one, other, mesh::facet_area_vector(facets_[other], x.values()).normalized(),
                           centre_of(facets_[other], x.values()), x.values()) > 0;
        };
        if (!behind_of(f, g) && !behind_of(g, f)) return true;
    }
    return false;
}

} // namespace osculate::model
