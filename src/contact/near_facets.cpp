#include "osculate/contact/near_facets.hpp"

#include "contact/box_tree.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

namespace osculate::contact {

namespace {
struct Group {
    std::vector<Leaf> leaves;
    bgi::rtree<Leaf, bgi::rstar<16>> tree;
};
} // namespace

std::vector<std::pair<Index, Index>> near_facets(const std::vector<mesh::Facet>& facets,
                                                 const std::vector<Index>& group, const std::vector<double>& margin,
                                                 const std::vector<Vec3>& x,
                                                 const std::function<bool(Index, Index)>& meet,
                                                 const std::function<bool(Index, Index)>& wanted) {
    std::vector<Group> groups(facets.empty() ? 0 : static_cast<std::size_t>(std::ranges::max(group)) + 1);
    for (std::size_t f = 0; f < facets.size(); ++f) {
        Vec3 low = Vec3::Constant(std::numeric_limits<double>::max()), high = -low;
        for (const Index node : facets[f]) {
            low = low.cwiseMin(x[node]);
            high = high.cwiseMax(x[node]);
        }
        low.array() -= margin[f];
        high.array() += margin[f];
        groups[group[f]].leaves.emplace_back(Box(to_point(low), to_point(high)), static_cast<Index>(f));
    }
    for (Group& one : groups) one.tree = decltype(one.tree)(one.leaves.begin(), one.leaves.end());
    std::vector<std::pair<Index, Index>> pairs;
    std::vector<Leaf> met;
    for (std::size_t a = 0; a < groups.size(); ++a)
        for (std::size_t b = a; b < groups.size(); ++b) {
            if (groups[a].leaves.empty() || groups[b].leaves.empty() ||
                !bg::intersects(groups[a].tree.bounds(), groups[b].tree.bounds()) ||
                !meet(static_cast<Index>(a), static_cast<Index>(b)))
                continue;
            const Box bounds = groups[b].tree.bounds();
            for (const auto& [box, f] : groups[a].leaves) {
                if (!bg::intersects(box, bounds)) continue;
                met.clear();
                groups[b].tree.query(bgi::intersects(box), std::back_inserter(met));
                for (const auto& [other, g] : met) {
                    if (a == b && g <= f) continue;
                    const auto [first, second] = std::minmax(f, g);
                    if (wanted(first, second)) pairs.emplace_back(first, second);
                }
            }
        }
    std::sort(pairs.begin(), pairs.end());
    return pairs;
}

} // namespace osculate::contact
