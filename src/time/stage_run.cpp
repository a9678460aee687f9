#include "time/stage_run.hpp"

#include "osculate/time/post_mortem.hpp"
#include "time/number.hpp"
#include "time/step_start.hpp"

#include <algorithm>
#include <cmath>
#include <span>

namespace osculate::time {

StageRun::StageRun(RunContext& context, const Stage& stage, Progress& progress, StepObserver& observer,
                   const Checkpoint* from)
    : context_(context), stage_(stage), progress_(progress), observer_(observer),
      constraints_(context.model.nodes(), stage.constraints), dynamics_(stage.dynamics ? &*stage.dynamics : nullptr),
      equilibrium_(context.model, constraints_, dynamics_, stage.tangent, context.timings, context.options.threads,
                   !stage.follower_pressures.empty()),
      solver_(equilibrium_.size(), context.timings),
      collisions_(context.model, equilibrium_.contact(), stage.limits, stage.follow_paths, context.timings,
                  context.options.threads),
      bounded_(std::isfinite(stage.limits.allowed_interpenetration) && !context.model.pairs.empty()) {
    const model::Model& model = context.model;
    if (from == nullptr) {
        progress_.displacement_start.reset(model.X.size());
        for (Index node = 0; node < model.nodes(); ++node)
            progress_.displacement_start[node] = constraints_.to_local(node, progress_.state.u[node]);
        progress_.stage_start = progress_.state.time;
        progress_.reached = 0;
        progress_.dt = stage.duration / stage.steps; // not end - begin: round-off would make every step another one
    }
    if (dynamics_ != nullptr && progress_.state.v.empty())
        start_motion(context_, stage, constraints_,
                     load_at(model, stage, constraints_, progress_.displacement_start, 0), progress_);
    if (dynamics_ != nullptr) centres_.emplace(model, *dynamics_, constraints_, context.options.threads);
    targets_ = times_to_hit(stage, progress_.stage_start);
    if (from != nullptr) equilibrium_.recall(from->memory);
}

void StageRun::run() {
    while (progress_.reached < targets_.size()) {
        const long factorised = solver_.factorisations(), iterated = solver_.gmres_iterations();
        StepAttempt attempt = prepare();
        if (wants_trial(attempt)) trial(attempt);
        if (attempt.decision.verdict == Verdict::accept) {
            solve(attempt);
            attempt.decision = judge(attempt.evidence, stage_.limits, attempt.dt, repeats_);
        }
        progress_.counts.factorisations += solver_.factorisations() - factorised;
        progress_.counts.gmres_iterations += solver_.gmres_iterations() - iterated;
        progress_.counts.paths_followed += collisions_.take_paths_followed();
        attempts_.push_back(row_of(attempt));
        if (attempt.decision.verdict == Verdict::accept)
            commit(attempt);
        else
            reject(attempt);
    }
}

equilibrium::StepLoad StageRun::mean_load(const StepAttempt& attempt, Field& u) const {
    const model::State& state = progress_.state;
    const double start = progress_.stage_start;
    equilibrium::StepLoad load =
        load_at(context_.model, stage_, constraints_, progress_.displacement_start, attempt.time - start);
    if (dynamics_ == nullptr) {
        if (context_.options.predictor) predict(context_.model, constraints_, load.prescribed, u);
        return load;
    }
    const equilibrium::StepLoad before =
        load_at(context_.model, stage_, constraints_, progress_.displacement_start, state.time - start);
    const double alpha = dynamics_->integrator.alpha_f;
    for (std::size_t i = 0; i < u.size(); ++i) {
        load.force[i] = (1 - alpha) * load.force[i] + alpha * before.force[i];
        u[i] = dynamics_->integrator.predictor(state.u[i], state.v[i], state.a[i], attempt.dt);
    }
    for (std::size_t p = 0; p < load.pressures.size(); ++p) load.pressures[p].start = before.pressures[p].end;
    return load;
}

StepAttempt StageRun::prepare() {
    const model::State& state = progress_.state;
    const StepperOptions& options = context_.options;
    const FittedStep fit = fit_to(state.time, progress_.dt, std::span(targets_).subspan(progress_.reached));
    StepAttempt attempt;
    attempt.proposed = progress_.dt;
    attempt.time = fit.time;
    attempt.dt = fit.dt;
    attempt.on_target = fit.on_target;

    Field u = state.u;
    equilibrium::StepLoad load = mean_load(attempt, u);
    if (dynamics_ != nullptr) attempt.force = load.force;
    if (bounded_ && repeats_ == 0) collisions_.begin_step(state);
    const double reference = reference_force(context_, stage_, constraints_, state, load, attempt.dt);
    equilibrium_.begin_attempt(state, load, attempt.dt);
    attempt.z = equilibrium_.unknowns(u, state.contact);
    attempt.unpredicted = equilibrium_.unknowns(state.u, state.contact);
    const Field start = equilibrium_.displacements(attempt.z);

    LadderOptions& ladder = attempt.ladder;
    ladder.tolerance = options.tolerance;
    ladder.max_iterations = options.max_iterations;
    ladder.characteristic_length = context_.characteristic_length;
    ladder.reference_force = reference;
    ladder.round_off = context_.round_off_force();
    ladder.farthest = context_.characteristic_length + largest_component(state.u);
    ladder.last_chance = cannot_be_cut(stage_.limits, attempt.dt, repeats_);
    if (context_.model.nonlinear) {
        ladder.predicted = u;
        ladder.unpredicted = state.u;
    }
    equilibrium_.set_reference_force(reference > 0 ? reference : 1);
    if (dynamics_ == nullptr) // inertia holds what nothing touches
        attempt.forced = starting_statuses(context_, equilibrium_.bodies(), state, start, attempt.statuses);
    else
        for (const model::ContactHistory& history : state.contact) attempt.statuses.push_back(history.status);
    if (dynamics_ == nullptr && options.stabilisation)
        ladder.stabilisation = stabilisation_options(context_, state, start);
    if (reference == 0) {
        equilibrium::Equilibrium alone(context_.model, constraints_, dynamics_, {}, context_.timings, options.threads,
                                       !stage_.follower_pressures.empty());
        alone.begin_attempt(state, std::move(load), attempt.dt);
        ladder.reference_force = imbalance(alone, attempt.z, attempt.statuses, attempt.forced);
    }
    return attempt;
}

bool StageRun::wants_trial(const StepAttempt& attempt) const {
    // the default of statics costs nothing where steps are easy
    const StepLimits& limits = stage_.limits;
    const bool easy = limits.usual_bound && repeats_ == 0 && attempt.proposed >= limits.dt_max * (1 - same_step);
    return bounded_ && !attempt.forced && !easy;
}

void StageRun::trial(StepAttempt& attempt) {
    Vector z = attempt.z;
    attempt.result = solve_trial(equilibrium_, solver_, z, attempt.statuses, attempt.ladder);
    attempt.iterations = attempt.result.iterations;
    if (!attempt.result.converged()) return;
    collisions_.add_trial(equilibrium_.displacements(z), attempt.evidence);
    attempt.evidence.iterations = attempt.iterations;
    attempt.decision = judge(attempt.evidence, stage_.limits, attempt.dt, repeats_);
    attempt.z = std::move(z);
    attempt.ladder.reference_force = attempt.result.reference_force;
    attempt.ladder.predicted.clear();
}

void StageRun::solve(StepAttempt& attempt) {
    attempt.result =
        climb(equilibrium_, solver_, attempt.z, attempt.unpredicted, attempt.statuses, attempt.forced, attempt.ladder);
    attempt.iterations += attempt.result.iterations;
    const int every = context_.options.reject_every;
    StepEvidence& evidence = attempt.evidence;
    evidence = {};
    evidence.solved = attempt.result.converged();
    evidence.hopeless = attempt.result.adrift >= 0;
    evidence.iterations = attempt.iterations;
    evidence.residual = attempt.result.residual;
    evidence.forced = every > 0 && (progress_.counts.attempts + 1) % every == 0;
    if (attempt.result.converged()) gather_evidence(attempt);
}

void StageRun::gather_evidence(StepAttempt& attempt) {
    StepEvidence& evidence = attempt.evidence;
    attempt.next = equilibrium_.state(attempt.z);
    attempt.next.time = attempt.time;
    if (dynamics_ != nullptr)
        attempt.ledger = advanced(progress_.ledger, context_.model, *dynamics_, equilibrium_, progress_.state,
                                  attempt.next, attempt.force);
    attempt.not_finite =
        find_not_finite(equilibrium_.contact(), attempt.next, dynamics_ != nullptr ? &attempt.ledger : nullptr);
    if (attempt.not_finite) {
        attempt.result.outcome = solve::KinsolOutcome::not_finite;
        evidence.solved = false;
    }
    if (bounded_) collisions_.add_solution(attempt.next.u, evidence);
    evidence.unseen = deepest_unseen(equilibrium_.contact());
    if (context_.audit && !attempt.not_finite) {
        const ScopedTimer timer(context_.timings, Part::audit);
        attempt.audit = &context_.audit->examine(attempt.next.u);
        evidence.intrusion = context_.audit->deepest();
    }
    if (dynamics_ != nullptr) gather_dynamic_evidence(attempt);
}

void StageRun::gather_dynamic_evidence(StepAttempt& attempt) {
    StepEvidence& evidence = attempt.evidence;
    const StepLimits& limits = stage_.limits;
    const Ledger &before = progress_.ledger, &after = attempt.ledger;
    const bool finite = !attempt.not_finite;
    if (std::isfinite(limits.error_tolerance)) {
        const AtNode worst =
            local_error(context_.model, *dynamics_, constraints_, progress_.state, attempt.next, attempt.dt);
        evidence.local_error = worst.value;
        attempt.worst_in_time = worst.node;
    }
    if (std::isfinite(limits.velocity_error) && finite)
        evidence.velocity_error = velocity_error(context_.model, *dynamics_, *centres_, progress_.state, attempt.next,
                                                 attempt.dt, std::max(energy_so_far(before), energy_so_far(after)));
    if (std::isfinite(limits.closing_energy) && finite) evidence.closing_energy = closing_energy(before, after);
    // a node with mass loses the same however short the step in which it lands
    evidence.closes_anyhow = lost_per_second_ > 0 && evidence.closing_energy > lost_per_second_ * attempt.dt;
    if (touches(progress_.state) || touches(attempt.next)) evidence.energy_jump = energy_from_nowhere(before, after);
}

Attempt StageRun::row_of(const StepAttempt& attempt) {
    const model::Model& model = context_.model;
    const Decision& decision = attempt.decision;
    Attempt row;
    row.attempt = ++progress_.counts.attempts;
    row.time = attempt.time;
    row.dt = attempt.dt;
    row.iterations = attempt.iterations;
    row.verdict = decision.verdict;
    row.reason = decision.reason;
    row.value = decision.value;
    row.lambda = decision.lambda;
    row.cause = decision.cause;
    if (decision.reason == Reason::solver) row.cause = explain(model, attempt.result, equilibrium_, row);
    if (decision.pair >= 0) name_node(model, model.pairs[decision.pair]->slaves().node[decision.slave], row);
    if (decision.intrusion) {
        name_node(model, decision.intrusion->node, row);
        row.cause = in_words(*decision.intrusion, model) + "; " + row.cause;
    }
    if (attempt.not_finite) explain(*attempt.not_finite, model, row);
    if (decision.reason == Reason::error && attempt.worst_in_time >= 0) name_node(model, attempt.worst_in_time, row);
    return row;
}

void StageRun::commit(StepAttempt& attempt) {
    equilibrium_.commit();
    progress_.state = attempt.next; // in place: its arrays stay where they are for whoever looks at them
    progress_.counts.stabilised_steps += attempt.result.stabilised_solves > 0 ? 1 : 0;
    progress_.counts.steps_at_round_off += equilibrium_.rests() ? 1 : 0;
    if (dynamics_ != nullptr) progress_.ledger = attempt.ledger;
    observer_.attempted(attempts_.back(), equilibrium_.records());
    observer_.accepted({progress_.state, equilibrium_, attempt.dt, attempt.iterations, stage_,
                        dynamics_ != nullptr ? &progress_.ledger : nullptr, attempt.audit});
    refit_patches();
    attempts_.clear();
    repeats_ = 0;
    lost_per_second_ = 0;
    progress_.reached += attempt.on_target ? 1 : 0;
    // a step that was short of a target alone keeps its size for the next
    progress_.dt = std::max(attempt.decision.dt, attempt.proposed);
    observer_.between_steps([this] { return checkpoint(); });
}

void StageRun::reject(const StepAttempt& attempt) {
    observer_.attempted(attempts_.back(), equilibrium_.records());
    if (attempt.decision.verdict == Verdict::give_up) give_up(attempt);
    equilibrium_.rollback();
    const Reason reason = attempt.decision.reason;
    if (reason == Reason::closing_energy) lost_per_second_ = attempt.evidence.closing_energy / attempt.dt;
    if (reason != Reason::forced) ++repeats_;
    progress_.dt = reason == Reason::forced ? attempt.proposed : attempt.decision.dt;
}

Checkpoint StageRun::checkpoint() const {
    Checkpoint now{progress_, equilibrium_.memory(), {}};
    for (const model::ContactHistory& history : progress_.state.contact)
        now.patches.push_back(history.master->refitted_patches());
    return now;
}

void StageRun::refit_patches() {
    const model::Model& model = context_.model;
    Field x;
    for (std::size_t p = 0; p < model.pairs.size(); ++p) {
        std::shared_ptr<const contact::MasterSurface>& master = progress_.state.contact[p].master;
        if (!master->refits()) continue;
        if (x.empty()) x = sum(model.X, progress_.state.u);
        const auto refitted = master->refitted(model.pairs[p]->vertices(x));
        if (!refitted) continue;
        progress_.counts.refreshed_patches += refitted->refits_done() - master->refits_done();
        master = refitted;
    }
}

void StageRun::give_up(const StepAttempt& attempt) {
    const FailedAttempt failed{context_.model, stage_,         progress_.state,  attempt.z,
                               attempt.result, attempt.ladder, attempt.decision, attempts_};
    const Attempt& row = attempts_.back();
    PostMortem found = examine(failed, equilibrium_);
    found.message = "stage '" + stage_.name + "', step of " + number(row.dt) + " s to time " + number(row.time) + " s" +
                    (attempt.result.adrift >= 0 ? "" : ", the smallest allowed,") + " failed. " + row.cause;
    model::State state = equilibrium_.state(attempt.z);
    state.time = row.time;
    const FailedIterate iterate{failed, state, equilibrium_};
    observer_.gave_up(found, &iterate);
    throw RunFailure(found.message);
}

} // namespace osculate::time
