#include "app/plan/draft_share.hpp"

#include "osculate/app/processes.hpp"
#include "osculate/solve/join_ranks.hpp"

#include <algorithm>
#include <iterator>

namespace osculate::app {

void check_distributed(Draft& draft) {
    std::ranges::move(cannot_be_shared(draft.plan.model), std::back_inserter(draft.faults));
}

std::shared_ptr<const Share> share_nodes(const Draft& draft, const Lists& neighbours) {
    const model::Model& m = draft.plan.model;
    Ranks& ranks = *draft.ranks;
    std::vector<double> first, all(static_cast<std::size_t>(m.nodes()));
    if (ranks.rank() == 0)
        for (const int owner : solve::share_nodes(neighbours, ranks.count(), model::followed_nodes(m)))
            first.push_back(owner);
    std::vector<int> sizes(static_cast<std::size_t>(ranks.count()), 0);
    sizes.front() = m.nodes();
    ranks.gather(first, sizes, all.data());
    return std::make_shared<Share>(draft.ranks, std::vector<int>(all.begin(), all.end()));
}

} // namespace osculate::app
