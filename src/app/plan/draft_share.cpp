#include "app/plan/draft_share.hpp"

#include "app/fault.hpp"
#include "osculate/solve/join_ranks.hpp"

namespace osculate::app {

void check_distributed(Draft& draft) {
    const model::Model& m = draft.plan.model;
    const auto refuse = [&](bool has, const char* key, const char* what) {
        if (has)
            draft.faults.push_back(fault(key, "a run without --distributed: processes cannot share this yet", what));
    };
    refuse(m.has_dependent_nodes() || !m.rigid.empty(), "scene",
           "nodes that follow others: rigid bodies, couplings, ties, equations or cyclic symmetry");
}

std::shared_ptr<const Share> share_nodes(const Draft& draft) {
    const model::Model& m = draft.plan.model;
    Ranks& ranks = *draft.ranks;
    std::vector<double> first, all(static_cast<std::size_t>(m.nodes()));
    if (ranks.rank() == 0)
        for (const int owner : solve::share_nodes(model::neighbours(m.bodies, m.nodes()), ranks.count()))
            first.push_back(owner);
    std::vector<int> sizes(static_cast<std::size_t>(ranks.count()), 0);
    sizes.front() = m.nodes();
    ranks.gather(first, sizes, all.data());
    return std::make_shared<Share>(draft.ranks, std::vector<int>(all.begin(), all.end()));
}

} // namespace osculate::app
