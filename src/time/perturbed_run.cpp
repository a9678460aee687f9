#include "osculate/time/perturbed_run.hpp"

#include "osculate/core/error.hpp"
#include "time/number.hpp"
#include "time/run_context.hpp"
#include "time/stage_state.hpp"

#include <optional>

namespace osculate::time {

/// A stage: what solves it, without any means to invert its tangent.
struct PerturbedRun::StageNow {
    StageNow(RunContext& context, const Stage& its, Progress& progress)
        : stage(its), constraints(constraints_of(context.model, its)), dynamics(its.dynamics),
          equilibrium(context.model, model::pairs_of(change_pairs(context, its, progress.state).contact), constraints,
                      dynamics ? &*dynamics : nullptr, {}, context.timings, context.options.threads,
                      !its.follower_pressures.empty()) {
        for (model::ContactEvaluation& evaluation : equilibrium.contact()) evaluation.pass_over_far_nodes(true);
        time::begin_stage(stage, constraints, progress);
        if (dynamics) begin_dynamics(context, stage, constraints, MassSolution::by_factors, progress);
    }

    const Stage& stage;
    linear::Constraints constraints;
    std::optional<equilibrium::Dynamics> dynamics; ///< of the step; none in statics
    equilibrium::Equilibrium equilibrium;
};

PerturbedRun::PerturbedRun(const model::Model& model, std::vector<Stage> stages, StepperOptions options,
                           Timings& timings)
    : stages_(std::move(stages)), context_(new RunContext{model, options, timings}), progress_(at_rest(model)) {}

PerturbedRun::~PerturbedRun() = default;

void PerturbedRun::begin_stage(std::size_t number) {
    now_ = nullptr;
    now_ = std::make_unique<StageNow>(*context_, stages_.at(number), progress_);
}

const equilibrium::Equilibrium& PerturbedRun::equilibrium() const {
    return now_->equilibrium;
}

const Ledger* PerturbedRun::ledger() const {
    return now_->dynamics ? &progress_.ledger : nullptr;
}

std::string PerturbedRun::begin_step(const BesideStep& step, Vector& F) {
    equilibrium::Equilibrium& own = now_->equilibrium;
    if (own.size() != step.z.size()) throw RunFailure("a derivative: the changed scene has other unknowns");
    if (now_->dynamics)
        now_->dynamics->integrator = step.impact ? equilibrium::backward_euler() : now_->stage.dynamics->integrator;
    equilibrium::StepLoad load = mean_load(context_->model, now_->stage, now_->constraints,
                                           now_->dynamics ? &*now_->dynamics : nullptr, progress_, step.time);
    force_ = load.force;
    own.set_reference_force(step.reference_force);
    own.begin_attempt(progress_.state, std::move(load), step.dt);
    return evaluate(step, step.z, F);
}

std::string PerturbedRun::evaluate(const BesideStep& step, const Vector& z, Vector& F) {
    equilibrium::Equilibrium& own = now_->equilibrium;
    own.set_statuses(step.statuses, equilibrium::StatusRule::frozen, false);
    for (std::size_t p = 0; p < step.contact.size(); ++p) own.contact()[p].take_facets(step.contact[p].held_facets());
    F.resize(z.size());
    if (own.residual(z, F) == solve::NonlinearProblem::Verdict::shorten || !F.allFinite())
        return "the changed scene has no residual";
    if (own.statuses() != step.statuses) return "a slave node of the changed scene has nothing to touch";
    return {};
}

void PerturbedRun::end_step(const BesideStep& step, const Vector& z) {
    equilibrium::Equilibrium& own = now_->equilibrium;
    model::State next = own.state(z);
    next.time = step.time;
    if (now_->dynamics)
        progress_.ledger = advanced(progress_.ledger, context_->model, *now_->dynamics, own, progress_.state, next,
                                    force_, step.impact);
    own.commit();
    progress_.state = std::move(next);
    refit_patches(context_->model, progress_);
}

void PerturbedPair::begin_stage(std::size_t number) {
    if (!lost_.empty()) return;
    below_->begin_stage(number);
    above_->begin_stage(number);
}

void PerturbedPair::follow(const BesideStep& step, const LinearSolve& inverse) {
    if (!lost_.empty()) return;
    const auto lose = [&](const std::string& why) { lost_ = "step to " + number(step.time) + " s: " + why; };
    Vector F_below, F_above, dz;
    for (const auto& [side, F] : {std::pair{below_.get(), &F_below}, std::pair{above_.get(), &F_above}})
        if (const std::string why = side->begin_step(step, *F); !why.empty()) return lose(why);
    if (!inverse(0.5 * (F_below - F_above), dz))
        return lose("the linear system with the tangent of the scene has no solution");
    const Vector z_below = step.z - dz, z_above = step.z + dz;
    for (const auto& [side, z] : {std::pair{below_.get(), &z_below}, std::pair{above_.get(), &z_above}})
        if (const std::string why = side->evaluate(step, *z, F_above); !why.empty()) return lose(why);
    below_->end_step(step, z_below);
    above_->end_step(step, z_above);
}

} // namespace osculate::time
