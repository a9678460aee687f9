#include "osculate/core/error.hpp"
#include "osculate/solve/join_ranks.hpp"

#include <metis.h>

namespace osculate::solve {

std::vector<int> share_nodes(const std::vector<std::vector<Index>>& neighbours, int ranks) {
    std::vector<int> owner(neighbours.size(), 0);
    if (ranks == 1 || neighbours.empty()) return owner;
    std::vector<idx_t> start{0}, other, weight;
    for (std::size_t i = 0; i < neighbours.size(); ++i) {
        for (const Index j : neighbours[i])
            if (static_cast<std::size_t>(j) != i) other.push_back(j);
        start.push_back(static_cast<idx_t>(other.size()));
        weight.push_back(static_cast<idx_t>(neighbours[i].size()));
    }
    idx_t options[METIS_NOPTIONS];
    METIS_SetDefaultOptions(options);
    options[METIS_OPTION_SEED] = 26;
    auto nodes = static_cast<idx_t>(neighbours.size()), parts = static_cast<idx_t>(ranks);
    idx_t constraints = 1, cut = 0;
    std::vector<idx_t> part(neighbours.size());
    const int status = METIS_PartGraphKway(&nodes, &constraints, start.data(), other.data(), weight.data(), nullptr,
                                           nullptr, &parts, nullptr, nullptr, options, &cut, part.data());
    if (status != METIS_OK) throw RunFailure("METIS could not share the nodes out among " + std::to_string(ranks));
    for (std::size_t i = 0; i < part.size(); ++i) owner[i] = static_cast<int>(part[i]);
    return owner;
}

} // namespace osculate::solve
