#include "time/stage_state.hpp"

#include "time/step_start.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace osculate::time {

Progress at_rest(const model::Model& model) {
    Progress progress;
    progress.state.u.reset(model.X.size());
    for (const auto& pair : model.pairs) progress.state.contact.push_back(model::opened(pair));
    progress.state.material = model::initial_history(model);
    progress.state.rigid.resize(model.rigid.size());
    return progress;
}

linear::Constraints constraints_of(const model::Model& model, const Stage& stage) {
    return {model.nodes(), stage.constraints, model::dependent_nodes(model), model::led_directions(model)};
}

const model::State& change_pairs(RunContext& context, const Stage& stage, model::State& state) {
    const auto bodies_of = [&](const model::ContactPair& pair) {
        const Index a = model::body_index(context.model, pair.slaves().node.front()),
                    b = model::body_index(context.model, pair.master_nodes().front());
        return std::pair(std::min(a, b), std::max(a, b));
    };
    std::set<std::pair<Index, Index>> apart, together;
    for (std::size_t p = 0; p < context.model.pairs.size(); ++p) {
        model::ContactHistory& history = state.contact[p];
        history.pair = stage.pairs.empty() ? context.model.pairs[p] : stage.pairs[p];
        (history.pair->options().in_force ? together : apart).insert(bodies_of(*history.pair));
        if (history.pair->options().in_force) continue;
        auto master = history.master;
        history = opened(history.pair);
        history.master = std::move(master);
    }
    for (const auto& bodies : together) apart.erase(bodies);
    if (context.audit) context.audit->pass_over(std::move(apart));
    return state;
}

void begin_stage(const Stage& stage, const linear::Constraints& constraints, Progress& progress) {
    const model::State& state = progress.state;
    progress.displacement_start.reset(state.u.size());
    for (Index node = 0; node < constraints.nodes(); ++node)
        progress.displacement_start[node] = constraints.to_local(node, state.u[node]);
    progress.stage_start = state.time;
    progress.reached = 0;
    progress.impact = false;
    progress.dt = stage.duration / stage.steps; // not end - begin: round-off would make every step another one
}

void begin_dynamics(RunContext& context, const Stage& stage, const linear::Constraints& constraints, MassSolution mass,
                    Progress& progress) {
    if (progress.state.v.empty())
        start_motion(context, stage, constraints,
                     load_at(context.model, stage, constraints, progress.displacement_start, 0), mass, progress);
    else
        revalue_interfaces(progress.ledger, context.model, progress.state);
}

equilibrium::StepLoad mean_load(const model::Model& model, const Stage& stage, const linear::Constraints& constraints,
                                const equilibrium::Dynamics* dynamics, const Progress& progress, double time) {
    const double start = progress.stage_start;
    equilibrium::StepLoad load = load_at(model, stage, constraints, progress.displacement_start, time - start);
    if (dynamics == nullptr) return load;
    const equilibrium::StepLoad before =
        load_at(model, stage, constraints, progress.displacement_start, progress.state.time - start);
    const double alpha = dynamics->integrator.alpha_f;
    for (std::size_t i = 0; i < load.force.size(); ++i)
        load.force[i] = (1 - alpha) * load.force[i] + alpha * before.force[i];
    for (std::size_t p = 0; p < load.pressures.size(); ++p) load.pressures[p].start = before.pressures[p].end;
    return load;
}

void refit_patches(const model::Model& model, Progress& progress) {
    Field x;
    for (model::ContactHistory& history : progress.state.contact) {
        std::shared_ptr<const contact::MasterSurface>& master = history.master;
        if (!master->refits()) continue;
        if (x.empty()) x = sum(model.X, progress.state.u);
        const auto refitted = master->refitted(history.pair->vertices(x));
        if (!refitted) continue;
        progress.counts.refreshed_patches += refitted->refits_done() - master->refits_done();
        master = refitted;
    }
}

} // namespace osculate::time
