#include "osculate/contact/near_facets.hpp"

#include "contact/box_tree.hpp"

#include <algorithm>
#include <iterator>
#include <limits>

namespace osculate::contact {

std::vector<std::pair<Index, Index>> near_facets(const std::vector<mesh::Facet>& facets,
                                                 const std::vector<double>& margin, const std::vector<Vec3>& x,
                                                 const std::function<bool(Index, Index)>& wanted) {
    std::vector<Leaf> leaves;
    leaves.reserve(facets.size());
    for (std::size_t f = 0; f < facets.size(); ++f) {
        Vec3 low = Vec3::Constant(std::numeric_limits<double>::max()), high = -low;
        for (const Index node : facets[f]) {
            low = low.cwiseMin(x[node]);
            high = high.cwiseMax(x[node]);
        }
        low.array() -= margin[f];
        high.array() += margin[f];
        leaves.emplace_back(Box(to_point(low), to_point(high)), static_cast<Index>(f));
    }
    const bgi::rtree<Leaf, bgi::rstar<16>> tree(leaves.begin(), leaves.end());
    std::vector<std::pair<Index, Index>> pairs;
    std::vector<Leaf> met;
    for (const auto& [box, f] : leaves) {
        met.clear();
        tree.query(bgi::intersects(box), std::back_inserter(met));
        const std::size_t first = pairs.size();
        for (const auto& [other, g] : met)
            if (g > f && wanted(f, g)) pairs.emplace_back(f, g);
        std::sort(pairs.begin() + static_cast<std::ptrdiff_t>(first), pairs.end());
    }
    return pairs;
}

} // namespace osculate::contact
