#include "osculate/time/checkpoint.hpp"

#include <algorithm>
#include <cmath>

namespace osculate::time {

namespace {

bool within(Index value, Index end) {
    return value >= 0 && value < end;
}

bool within(const std::vector<Index>& values, Index end) {
    return std::ranges::all_of(values, [&](Index value) { return within(value, end); });
}

template <class List> bool finite(const List& values) {
    return std::ranges::all_of(values, [](const auto& value) { return value.allFinite(); });
}

std::string misfit(const model::ContactHistory& history, const model::ContactPair& pair) {
    const auto slaves = static_cast<std::size_t>(pair.size());
    const std::string whose = " of pair '" + pair.name() + "'";
    if (history.lambda.size() != slaves || history.status.size() != slaves || history.facet.size() != slaves)
        return "slave nodes" + whose;
    if (!finite(history.lambda)) return "contact forces" + whose;
    for (const contact::Status status : history.status)
        if (status > contact::Status::glide) return "contact statuses" + whose;
    const Index facets = pair.surface().facet_count();
    for (const Index facet : history.facet)
        if (facet != -1 && !within(facet, facets)) return "contact facets" + whose;
    return {};
}

std::string misfit(const equilibrium::EquilibriumMemory& memory, const model::Model& model) {
    std::vector<Index> slaves;
    for (const auto& pair : model.pairs)
        slaves.insert(slaves.end(), pair->slaves().node.begin(), pair->slaves().node.end());
    if (!memory.couplings.empty()) {
        if (!std::ranges::equal(memory.couplings, slaves, {}, &linear::Coupling::slave)) return "slave nodes";
        for (const linear::Coupling& coupling : memory.couplings)
            if (!within(coupling.masters, model.nodes()) || !std::ranges::is_sorted(coupling.masters))
                return "master nodes";
    }
    if (memory.springs)
        for (const linear::Spring& spring : *memory.springs)
            if (!within(spring.slave, model.nodes()) || !within(spring.masters, model.nodes())) return "springs";
    if (!memory.laws) return {};
    const linear::ContactLaws& laws = *memory.laws;
    const std::size_t count = laws.terms.size();
    if (!std::isfinite(laws.dt) || !within(laws.couplings, static_cast<Index>(slaves.size())) ||
        laws.couplings.size() > count || laws.B.size() != count || laws.D.size() != count || !finite(laws.B) ||
        !finite(laws.D))
        return "contact laws";
    for (const auto& terms : laws.terms)
        for (const linear::ContactLaws::Term& term : terms) // contact nodes are some of all
            if (!within(term.node, model.nodes()) || !term.by.allFinite()) return "contact laws";
    return {};
}

} // namespace

std::string misfit(const Checkpoint& checkpoint, const model::Model& model, std::size_t stages) {
    const model::State& state = checkpoint.state;
    const auto nodes = static_cast<std::size_t>(model.nodes());
    if (checkpoint.stage >= stages) return "number of stages";
    if (!std::isfinite(checkpoint.stage_start) || !std::isfinite(state.time) || state.time < checkpoint.stage_start ||
        !(checkpoint.dt > 0) || !std::isfinite(checkpoint.dt))
        return "times";
    if (state.u.size() != nodes || checkpoint.displacement_start.size() != nodes || state.v.size() != state.a.size() ||
        (!state.v.empty() && state.v.size() != nodes))
        return "number of nodes";
    if (state.material.size() != model::initial_history(model).size()) return "values that materials remember";
    if (!finite(state.u) || !finite(state.v) || !finite(state.a) || !finite(checkpoint.displacement_start))
        return "values that are not finite";
    if (state.contact.size() != model.pairs.size() || checkpoint.patches.size() != model.pairs.size())
        return "number of contact pairs";
    for (std::size_t p = 0; p < model.pairs.size(); ++p)
        if (const std::string what = misfit(state.contact[p], *model.pairs[p]); !what.empty()) return what;
    for (const auto& patches : checkpoint.patches)
        for (const contact::RefittedPatch& patch : patches)
            if (!finite(patch.at)) return "patches";
    return misfit(checkpoint.memory, model);
}

} // namespace osculate::time
