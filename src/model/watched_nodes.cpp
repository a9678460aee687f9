/// Places where an audit has found bodies inside one another, which general contact watches.

#include "osculate/model/general_contact.hpp"

#include <algorithm>

namespace osculate::model {

namespace {
/// Depth from which a place is watched, in facet sizes: well before the audit rejects a step, and beyond what contacts yield.
constexpr double watched_from = 0.02;
} // namespace

std::vector<WatchedNode> GeneralContact::watched(const std::vector<WatchedNode>& now,
                                                 const std::vector<contact::IntrudedPlace>& places) const {
    std::vector<WatchedNode> all = now;
    const auto add = [&](const std::array<Index, 4>& nodes, std::size_t of, std::size_t surface) {
        const std::map<Index, Index>& skin = surfaces_[of].skin;
        for (const Index node : nodes) {
            if (node < 0) continue;
            const auto at = skin.find(node);
            all.push_back({at != skin.end() ? at->second : node, static_cast<Index>(surface)});
        }
    };
    for (const contact::IntrudedPlace& place : places) {
        if (!meet(place.body, place.other)) continue;
        const std::size_t a = surface_of_body(place.body), b = surface_of_body(place.other);
        const bool smooth = surfaces_[a].smooth || surfaces_[b].smooth;
        if (!((smooth ? place.excess : place.depth) > watched_from * place.length)) continue;
        add(place.parts, a, b);
        add(place.facet, b, a);
    }
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
}

bool GeneralContact::is_watched(const std::vector<WatchedNode>& watched, const ConvexEdge& edge, Index surface) const {
    const MasterSide& side = *surfaces_[static_cast<std::size_t>(edge.surface)].side;
    return std::ranges::any_of(contact::vertices_of_edge(side.surface(), edge.half_edge), [&](Index vertex) {
        const Index node = side.nodes()[static_cast<std::size_t>(vertex)];
        return std::ranges::binary_search(watched, WatchedNode{node, surface});
    });
}

} // namespace osculate::model
