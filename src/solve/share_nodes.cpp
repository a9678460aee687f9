#include "osculate/core/error.hpp"
#include "osculate/solve/join_ranks.hpp"

#include <algorithm>
#include <metis.h>
#include <numeric>

namespace osculate::solve {
namespace {

/// (nodes) numbers from 0 on, the same for nodes that pairs join.
std::vector<Index> groups(std::size_t nodes, std::span<const std::pair<Index, Index>> together) {
    std::vector<Index> first(nodes);
    std::iota(first.begin(), first.end(), 0);
    const auto root = [&](Index i) {
        while (first[i] != i) i = first[i] = first[first[i]];
        return i;
    };
    for (const auto& [a, b] : together) {
        const Index one = root(a), other = root(b);
        first[std::max(one, other)] = std::min(one, other);
    }
    std::vector<Index> number(nodes, -1);
    Index count = 0;
    for (std::size_t i = 0; i < nodes; ++i) { // a root is the first of its group
        const Index own = root(static_cast<Index>(i));
        number[i] = own == static_cast<Index>(i) ? count++ : number[own];
    }
    return number;
}

} // namespace

std::vector<int> share_nodes(const std::vector<std::vector<Index>>& neighbours, int ranks,
                             std::span<const std::pair<Index, Index>> together) {
    std::vector<int> owner(neighbours.size(), 0);
    if (ranks == 1 || neighbours.empty()) return owner;
    const std::vector<Index> group = groups(neighbours.size(), together);
    std::vector<std::vector<Index>> members(static_cast<std::size_t>(std::ranges::max(group)) + 1);
    for (std::size_t i = 0; i < group.size(); ++i) members[group[i]].push_back(static_cast<Index>(i));
    std::vector<idx_t> start{0}, other, weight;
    std::vector<Index> beside;
    for (std::size_t g = 0; g < members.size(); ++g) {
        beside.clear();
        idx_t blocks = 0;
        for (const Index i : members[g]) {
            blocks += static_cast<idx_t>(neighbours[i].size());
            for (const Index j : neighbours[i])
                if (group[j] != static_cast<Index>(g)) beside.push_back(group[j]);
        }
        std::ranges::sort(beside);
        other.insert(other.end(), beside.begin(), std::unique(beside.begin(), beside.end()));
        start.push_back(static_cast<idx_t>(other.size()));
        weight.push_back(blocks);
    }
    idx_t options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = 26;
    // thousandths by which a part may be larger than the mean: the slowest makes all wait
    options[METIS_OPTION_UFACTOR] = 3;
    auto nodes = static_cast<idx_t>(members.size()), parts = static_cast<idx_t>(ranks);
    idx_t constraints = 1, cut = 0;
    std::vector<idx_t> part(members.size());
    const int status = METIS_PartGraphKway(&nodes, &constraints, start.data(), other.data(), weight.data(), nullptr,
                                           nullptr, &parts, nullptr, nullptr, options, &cut, part.data());
    if (status != METIS_OK) throw RunFailure("METIS could not share the nodes out among " + std::to_string(ranks));
    for (std::size_t i = 0; i < owner.size(); ++i)
        owner[i] = static_cast<int>(part[static_cast<std::size_t>(group[i])]);
    return owner;
}

} // namespace osculate::solve
