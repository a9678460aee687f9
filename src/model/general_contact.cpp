#include "osculate/model/general_contact.hpp"

#include "osculate/contact/near_facets.hpp"
#include "osculate/core/error.hpp"
#include "osculate/fe/facet_quadrature.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace osculate::model {

namespace {

/// Factors by which two facets must differ before their order decides; of stiffness, before their sizes do.
constexpr double clearly = 1.1, much_stiffer = 100;
/// A node points at a surface if no edge that meets there goes deeper into it than this, over its length.
constexpr double pointing = -0.5;

double area_of(const mesh::Facet& facet, const std::vector<Vec3>& X) {
    const auto shares = fe::tributary_areas(facet, X);
    return std::accumulate(shares.begin(), shares.end(), 0.0);
}

} // namespace

GeneralContact::GeneralContact(std::vector<OuterSurface> surfaces, GeneralContactOptions options,
                               const std::vector<Vec3>& X)
    : surfaces_(std::move(surfaces)), options_(std::move(options)), X_(X), surface_of_(X.size(), -1),
      node_facets_(X.size()), along_(X.size()), left_out_(surfaces_.size() * surfaces_.size(), 0) {
    for (std::size_t s = 0; s < surfaces_.size(); ++s) {
        first_.push_back(static_cast<Index>(facets_.size()));
        Vec3 low = Vec3::Constant(std::numeric_limits<double>::max()), high = -low;
        for (const mesh::Facet& facet : surfaces_[s].facets)
            for (const Index node : facet) {
                low = low.cwiseMin(X[node]);
                high = high.cwiseMax(X[node]);
            }
        diagonal_.push_back((high - low).norm());
        for (const mesh::Facet& facet : surfaces_[s].facets) {
            const auto number = static_cast<Index>(facets_.size());
            facets_.push_back(facet);
            data_.push_back({static_cast<Index>(s), std::sqrt(area_of(facet, X))});
            for (int c = 0; c < facet.count; ++c) {
                const Index a = facet.nodes[static_cast<std::size_t>(c)],
                            b = facet.nodes[static_cast<std::size_t>((c + 1) % facet.count)];
                surface_of_[a] = static_cast<Index>(s);
                node_facets_[a].push_back(number);
                along_[a].push_back(b);
                along_[b].push_back(a);
            }
        }
    }
    for (std::vector<Index>& ends : along_) {
        std::ranges::sort(ends);
        ends.erase(std::unique(ends.begin(), ends.end()), ends.end());
    }
    for (const auto& [a, b] : options_.left_out)
        left_out_[static_cast<std::size_t>(a) * surfaces_.size() + static_cast<std::size_t>(b)] =
            left_out_[static_cast<std::size_t>(b) * surfaces_.size() + static_cast<std::size_t>(a)] = 1;
    find_convex_edges();
    around_.resize(X.size());
    for (std::size_t s = 0; s < surfaces_.size(); ++s) {
        if (left_out_[s * surfaces_.size() + s] != 0) continue;
        const MasterSide& side = *surfaces_[s].side;
        std::vector<std::vector<Index>> near = neighbourhoods(surfaces_[s]);
        for (Index v = 0; v < side.surface().vertex_count(); ++v)
            if (side.own_vertex(v) == v) around_[side.nodes()[v]] = std::move(near[v]);
    }
    for (const auto& [one, other] : options_.treated_elsewhere) {
        std::vector<char>& marks = treated_.emplace_back(X.size(), 0);
        for (const Index node : one) marks[node] |= 1;
        for (const Index node : other) marks[node] |= 2;
    }
}

std::size_t GeneralContact::surface_of_body(Index body) const {
    return static_cast<std::size_t>(std::ranges::find(surfaces_, body, &OuterSurface::body) - surfaces_.begin());
}

bool GeneralContact::meet(Index body, Index other) const {
    const std::size_t a = surface_of_body(body), b = surface_of_body(other), n = surfaces_.size();
    return a < n && b < n && left_out_[a * n + b] == 0;
}

bool GeneralContact::pass_through(Index body, Index other) const {
    const std::size_t a = surface_of_body(body), b = surface_of_body(other), n = surfaces_.size();
    return a < n && b < n && left_out_[a * n + b] != 0;
}

bool GeneralContact::may_meet(Index f, Index g) const {
    const auto a = static_cast<std::size_t>(data_[f].surface), b = static_cast<std::size_t>(data_[g].surface);
    if (left_out_[a * surfaces_.size() + b] != 0 || (a == b && are_neighbours(f, g))) return false;
    return !is_treated(facets_[f], facets_[g]);
}

template <class Some, class Others> bool GeneralContact::is_treated(const Some& some, const Others& others) const {
    const auto all = [](const std::vector<char>& marks, const auto& nodes, char side) {
        return std::ranges::all_of(nodes, [&](Index node) { return (marks[node] & side) != 0; });
    };
    return std::ranges::any_of(treated_, [&](const std::vector<char>& marks) {
        return (all(marks, some, 1) && all(marks, others, 2)) || (all(marks, some, 2) && all(marks, others, 1));
    });
}

bool GeneralContact::is_slave(Index f, Index g) const {
    const OuterSurface &a = surfaces_[data_[f].surface], &b = surfaces_[data_[g].surface];
    const double finer = data_[g].size / data_[f].size, softer = b.E / a.E;
    if (std::max(softer, 1 / softer) > much_stiffer) return softer > 1;
    if (std::max(finer, 1 / finer) > clearly) return finer > 1;
    if (std::max(softer, 1 / softer) > clearly) return softer > 1;
    return data_[f].surface < data_[g].surface;
}

std::vector<ContactHistory> GeneralContact::near(ContactScope& scope, const std::vector<ContactHistory>& before) const {
    const std::vector<Vec3>& x = scope.x;
    std::vector<double> margin;
    for (const Facet& facet : data_) margin.push_back(scope.margin[static_cast<std::size_t>(facet.surface)]);
    const FacetPlaces places_now = places(x);
    const std::vector<Vec3>&normal = places_now.normal, &centre = places_now.centre;
    const FacetPairs near = near_pairs(scope, places_now);
    scope.passed = passed(scope, places_now, near);
    // the nearest facet of every other surface that a facet faces
    std::map<std::pair<Index, Index>, std::pair<double, Index>> nearest; // (facet, other surface)
    std::map<std::pair<Index, Index>, Found> found;                      // (slave, master) surfaces
    const auto consider = [&](Index f, Index g) {
        const double distance = (centre[f] - centre[g]).norm();
        const auto [at, fresh] = nearest.try_emplace({f, data_[g].surface}, distance, g);
        if (!fresh && distance < at->second.first) at->second = {distance, g};
    };
    FacetPairs own;
    for (const auto& [f, g] : near)
        if (data_[f].surface == data_[g].surface && normal[f].dot(normal[g]) < contact::facing) own.emplace_back(f, g);
    const std::vector<Role> roles = roles_within(own, before);
    const auto leads = [&](Index f, Index g) { // whether f is the slave
        if (data_[f].surface != data_[g].surface) return is_slave(f, g);
        return roles.empty() || roles[f] == roles[g] ? f < g : roles[f] < roles[g];
    };
    const auto leads_not = [&](Index node) { // within its own surface
        return !roles.empty() &&
               std::ranges::any_of(node_facets_[node], [&](Index f) { return roles[f] == Role::master; });
    };
    const auto points_at = [&](Index node, Index g) {
        const Vec3& n = normal[g];
        const Index its = node_facets_[node][0];
        const double moved = data_[its].surface == data_[g].surface ? 0 : margin[its] + margin[g];
        if (!(n.dot(x[node] - centre[g]) > -behind * std::min(data_[its].size, data_[g].size) - moved)) return false;
        double facets = 0;
        for (const Index f : node_facets_[node]) facets += normal[f].dot(n);
        return facets < 0 && !is_treated(std::array{node}, facets_[g]) &&
               std::ranges::all_of(along_[node],
                                   [&](Index end) { return (x[end] - x[node]).normalized().dot(n) >= pointing; });
    };
    for (const auto& [f, g] : near) {
        if (data_[f].surface != data_[g].surface)
            for (const auto& [one, other] : {std::pair{f, g}, std::pair{g, f}})
                if (!leads(one, other))
                    for (const Index node : facets_[one])
                        if (sharp_[node] != 0 && points_at(node, other))
                            found[{data_[one].surface, data_[other].surface}].yielding.push_back(node);
        if (normal[f].dot(normal[g]) < contact::facing) {
            // faces that look away from each other are back to back
            if (missing(f, g, normal[g], centre[g], x) > 0 || missing(g, f, normal[f], centre[f], x) > 0) continue;
            consider(f, g);
            consider(g, f);
        } else { // corners and edges whose facets look past the other
            for (const auto& [one, other] : {std::pair{f, g}, std::pair{g, f}})
                if (leads(one, other))
                    for (const Index node : facets_[one])
                        if (points_at(node, other) && !(data_[one].surface == data_[other].surface && leads_not(node)))
                            found[{data_[one].surface, data_[other].surface}].nodes.push_back(node);
        }
    }
    std::vector<WatchedNode> watched; // still near
    for (const auto& [f, g] : near)
        for (const auto& [one, other] : {std::pair{f, g}, std::pair{g, f}})
            for (const Index node : facets_[one])
                if (const WatchedNode here{node, data_[other].surface};
                    data_[one].surface != here.surface && std::ranges::binary_search(scope.watched, here))
                    watched.push_back(here);
    std::ranges::sort(watched);
    watched.erase(std::unique(watched.begin(), watched.end()), watched.end());
    for (const auto& [node, surface] : watched) found[{surface_of_[node], surface}].yielding.push_back(node);
    scope.watched = std::move(watched);
    for (const auto& [who, what] : nearest)
        if (leads(who.first, what.second)) found[{data_[who.first].surface, who.second}].facets.push_back(who.first);
    for (const ContactHistory& history : before) {
        const SlaveNodes& slaves = history.pair->slaves();
        for (std::size_t j = 0; j < history.status.size() && !slaves.edges; ++j)
            if (contact::is_closed(history.status[j])) {
                Found& part = found[sides_of(*history.pair)];
                (slaves.yields.empty() || slaves.yields[j] == 0 ? part.nodes : part.yielding).push_back(slaves.node[j]);
            }
    }
    const auto in_order = [](std::vector<Index>& nodes) {
        std::ranges::sort(nodes);
        nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    };

    std::vector<ContactHistory> histories;
    for (auto& entry : found) {
        const std::pair<Index, Index>& sides = entry.first;
        Found& part = entry.second;
        std::vector<mesh::Facet> facets;
        for (const Index f : part.facets) {
            facets.push_back(facets_[f]);
            part.nodes.insert(part.nodes.end(), facets_[f].begin(), facets_[f].end());
        }
        in_order(part.nodes);
        in_order(part.yielding);
        std::erase_if(part.yielding, [&](Index node) {
            return std::ranges::binary_search(part.nodes, node) &&
                   !std::ranges::binary_search(scope.watched, WatchedNode{node, sides.second});
        });
        part.nodes.insert(part.nodes.end(), part.yielding.begin(), part.yielding.end());
        in_order(part.nodes);
        const auto old = std::ranges::find_if(before, [&](const ContactHistory& history) {
            return !history.pair->slaves().edges && sides_of(*history.pair) == sides;
        });
        ContactHistory& history = histories.emplace_back(
            opened(make_pair(scope, sides.first, sides.second, part.nodes, std::move(facets), part.yielding)));
        if (old == before.end()) continue;
        history.master = old->master;
        if (!old->slides.empty()) history.slides.assign(history.status.size(), 0);
        const std::vector<Index>& known = old->pair->slaves().node;
        for (std::size_t j = 0; j < part.nodes.size(); ++j) {
            const auto at = std::ranges::lower_bound(known, part.nodes[j]);
            if (at == known.end() || *at != part.nodes[j]) continue;
            const auto k = static_cast<std::size_t>(at - known.begin());
            history.lambda[j] = old->lambda[k];
            history.status[j] = old->status[k];
            history.facet[j] = old->facet[k];
            if (!history.slides.empty()) history.slides[j] = old->slides[k];
        }
    }
    add_edges(scope, before, histories);
    return histories;
}

std::shared_ptr<const ContactPair> GeneralContact::make_pair(const ContactScope& scope, Index slave, Index master,
                                                             const std::vector<Index>& nodes,
                                                             std::vector<mesh::Facet> facets,
                                                             const std::vector<Index>& yielding) const {
    const OuterSurface &own = surfaces_[static_cast<std::size_t>(slave)],
                       &other = surfaces_[static_cast<std::size_t>(master)];
    SlaveNodes slaves;
    slaves.node = nodes;
    slaves.area.assign(nodes.size(), 0);
    const auto number = [&](Index node) { return std::ranges::lower_bound(nodes, node) - nodes.begin(); };
    for (const mesh::Facet& facet : facets) {
        const auto shares = fe::tributary_areas(facet, X_);
        for (int c = 0; c < facet.count; ++c)
            slaves.area[static_cast<std::size_t>(number(facet.nodes[static_cast<std::size_t>(c)]))] +=
                shares[static_cast<std::size_t>(c)];
    }
    const double E = std::min(own.E, other.E);
    for (std::size_t j = 0; j < nodes.size(); ++j) {
        double all = 0, largest = 0; // of all facets that meet at the node
        for (const Index f : node_facets_[nodes[j]]) {
            const auto shares = fe::tributary_areas(facets_[f], X_);
            for (int c = 0; c < facets_[f].count; ++c)
                if (facets_[f].nodes[static_cast<std::size_t>(c)] == nodes[j])
                    all += shares[static_cast<std::size_t>(c)];
            largest = std::max(largest, data_[f].size);
        }
        if (slaves.area[j] == 0) slaves.area[j] = all;
        slaves.stiffness.push_back(options_.stiffness_scale * E * slaves.area[j] / largest);
        slaves.along.push_back(along_[nodes[j]]);
        std::vector<mesh::Facet>& around = slaves.around.emplace_back();
        for (const Index f : node_facets_[nodes[j]]) around.push_back(facets_[f]);
    }
    if (averages(options_.pair.discretisation) &&
        std::ranges::any_of(nodes, [&](Index node) { return own.in_plane.contains(node); }))
        for (const Index node : nodes) {
            const auto plane = own.in_plane.find(node);
            slaves.in_plane.push_back(plane != own.in_plane.end() ? plane->second : Mat3(Mat3::Identity()));
        }
    slaves.facets = std::move(facets);
    if (!scope.watched.empty())
        for (const Index node : nodes)
            slaves.watched.push_back(std::ranges::binary_search(scope.watched, WatchedNode{node, master}));
    if (!yielding.empty()) {
        slaves.yields.assign(nodes.size(), 0);
        for (const Index node : yielding) slaves.yields[static_cast<std::size_t>(number(node))] = 1;
    }
    if (!treated_.empty()) {
        const mesh::HalfEdgeSurface& surface = other.side->surface();
        slaves.treated.resize(nodes.size());
        slaves.facet_treated.resize(static_cast<std::size_t>(surface.facet_count()));
        for (std::size_t k = 0; k < treated_.size(); ++k)
            for (const int side : {1, 2}) {
                const Index number_of_side = 2 * static_cast<Index>(k) + side - 1;
                for (std::size_t j = 0; j < nodes.size(); ++j)
                    if ((treated_[k][nodes[j]] & side) != 0) slaves.treated[j].push_back(number_of_side);
                for (Index f = 0; f < surface.facet_count(); ++f)
                    if (std::ranges::all_of(surface.facet_vertices(f), [&](Index v) {
                            return (treated_[k][other.side->nodes()[v]] & (3 - side)) != 0;
                        }))
                        slaves.facet_treated[static_cast<std::size_t>(f)].push_back(number_of_side);
            }
    }
    if (slave == master) {
        OwnSurface& within = slaves.own.emplace();
        for (const Index node : nodes) {
            within.around.push_back(around_[node]);
        }
        within.reach = 2 * scope.own[static_cast<std::size_t>(slave)];
    }
    ContactOptions options = options_.pair;
    options.friction = options_.friction(slave, master);
    if (options_.static_friction.size() > 0) options.static_friction = options_.static_friction(slave, master);
    return std::make_shared<const ContactPair>("general: " + own.name + " on " +
                                                   (slave == master ? "itself" : other.name),
                                               X_, std::move(slaves), other.side, options);
}

std::pair<Index, Index> GeneralContact::sides_of(const ContactPair& pair) const {
    const auto master = std::ranges::find_if(
        surfaces_, [&](const OuterSurface& surface) { return surface.side.get() == &pair.master_side(); });
    require(master != surfaces_.end(), "no pair of general contact");
    return {surface_of_[pair.slaves().node.front()], static_cast<Index>(master - surfaces_.begin())};
}

std::vector<Index> GeneralContact::possible_slaves() const {
    // the first of two alike, and whatever is finer or softer than any other
    std::vector<Index> nodes;
    for (std::size_t a = 0; a < surfaces_.size(); ++a) {
        bool some = false;
        for (std::size_t b = 0; b < surfaces_.size() && !some; ++b) {
            if (a == b || left_out_[a * surfaces_.size() + b] != 0) continue;
            Index finest = -1, coarsest = -1;
            for (Index f = 0; f < static_cast<Index>(data_.size()); ++f) {
                if (data_[f].surface == static_cast<Index>(a) && (finest < 0 || data_[f].size < data_[finest].size))
                    finest = f;
                if (data_[f].surface == static_cast<Index>(b) && (coarsest < 0 || data_[f].size > data_[coarsest].size))
                    coarsest = f;
            }
            some = finest >= 0 && coarsest >= 0 && is_slave(finest, coarsest);
        }
        if (!some) continue;
        for (const mesh::Facet& facet : surfaces_[a].facets) nodes.insert(nodes.end(), facet.begin(), facet.end());
    }
    std::ranges::sort(nodes);
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
}

} // namespace osculate::model
