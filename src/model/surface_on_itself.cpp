/// General contact of a surface with itself: what is near along it, and which side is the slave.

#include "osculate/model/general_contact.hpp"

#include <algorithm>
#include <deque>
#include <functional>
#include <limits>
#include <map>
#include <queue>

namespace osculate::model {

namespace {
/// Facets of one surface do not meet if they are nearer along it than this, in sizes of the larger one: folds between them are
/// sharper than what the mesh resolves.
constexpr double neighbourhood = 2.5;
} // namespace

std::vector<std::vector<Index>> GeneralContact::neighbourhoods(const OuterSurface& surface) const {
    const mesh::HalfEdgeSurface& mesh = surface.side->surface();
    const std::vector<Vec3> X = surface.side->vertices(X_);
    std::vector<std::vector<std::pair<Index, double>>> edges(X.size());
    for (const mesh::HalfEdge& edge : mesh.half_edges()) {
        const Index a = edge.origin, b = mesh.half_edges()[edge.next].origin;
        const double length = (X[b] - X[a]).norm();
        edges[a].emplace_back(b, length);
        edges[b].emplace_back(a, length);
    }
    std::vector<std::vector<Index>> all(X.size());
    std::vector<double> distance(X.size(), std::numeric_limits<double>::infinity());
    std::vector<Index> reached;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
        double size = 0;
        for (const Index f : mesh.vertex_facets(v)) size = std::max(size, mesh.facet_size(f));
        std::priority_queue<std::pair<double, Index>, std::vector<std::pair<double, Index>>, std::greater<>> waiting;
        waiting.emplace(0, v);
        distance[v] = 0;
        reached.assign(1, v);
        while (!waiting.empty()) {
            const auto [d, at] = waiting.top();
            waiting.pop();
            if (d > distance[at]) continue;
            const auto facets = mesh.vertex_facets(at);
            all[v].insert(all[v].end(), facets.begin(), facets.end());
            for (const auto& [next, length] : edges[at]) {
                if (d + length > neighbourhood * size || d + length >= distance[next]) continue;
                distance[next] = d + length;
                reached.push_back(next);
                waiting.emplace(d + length, next);
            }
        }
        for (const Index at : reached) distance[at] = std::numeric_limits<double>::infinity();
        std::ranges::sort(all[v]);
        all[v].erase(std::unique(all[v].begin(), all[v].end()), all[v].end());
    }
    return all;
}

bool GeneralContact::are_neighbours(Index f, Index g) const {
    const auto near = [&](Index one, Index other) {
        const Index number = other - first_[static_cast<std::size_t>(data_[other].surface)];
        return std::ranges::any_of(facets_[one],
                                   [&](Index node) { return std::ranges::binary_search(around_[node], number); });
    };
    return near(f, g) || near(g, f);
}

std::vector<GeneralContact::Role> GeneralContact::roles_within(const FacetPairs& facing,
                                                               const std::vector<ContactHistory>& before) const {
    if (facing.empty()) return {};
    std::map<Index, std::vector<Index>> faced;
    for (const auto& [f, g] : facing) {
        faced[f].push_back(g);
        faced[g].push_back(f);
    }
    std::vector<Role> roles(facets_.size(), Role::none);
    // both roles spread alike, so that they meet at the ends of folds
    std::deque<std::pair<Index, Role>> waiting;
    const auto spread = [&] {
        for (; !waiting.empty(); waiting.pop_front()) {
            const auto [f, role] = waiting.front();
            if (roles[f] != Role::none) continue;
            roles[f] = role;
            for (const Index g : faced[f]) waiting.emplace_back(g, role == Role::slave ? Role::master : Role::slave);
            const auto s = static_cast<std::size_t>(data_[f].surface);
            for (const Index next : surfaces_[s].side->surface().edge_neighbours(f - first_[s]))
                if (next >= 0 && next < static_cast<Index>(surfaces_[s].facets.size()) &&
                    faced.contains(next + first_[s]))
                    waiting.emplace_back(next + first_[s], role);
        }
    };
    for (const ContactHistory& history : before) {
        const auto [slaves, masters] = sides_of(*history.pair);
        if (slaves != masters) continue;
        for (const mesh::Facet& facet : history.pair->slaves().facets)
            for (const Index f : node_facets_[facet.nodes[0]])
                if (facets_[f].nodes == facet.nodes && faced.contains(f)) waiting.emplace_back(f, Role::slave);
    }
    spread();
    for (const auto& [f, others] : faced) {
        waiting.emplace_back(f, Role::slave);
        spread();
    }
    return roles;
}

} // namespace osculate::model
