#include "time/stage_run.hpp"

#include "osculate/model/general_contact.hpp"
#include "osculate/time/far_force.hpp"
#include "osculate/time/post_mortem.hpp"
#include "time/number.hpp"
#include "time/stage_state.hpp"
#include "time/step_start.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <set>
#include <span>

namespace osculate::time {

namespace {
/// Histories of the pairs that general contact has found.
std::vector<model::ContactHistory> of_general_contact(const model::State& state, const model::Model& model) {
    return {state.contact.begin() + static_cast<std::ptrdiff_t>(model.pairs.size()), state.contact.end()};
}

equilibrium::TangentChoice tangent_choice(const model::Model& model, const Stage& stage, const model::State& state) {
    if (!model.general || !state.scope) return stage.tangent;
    return equilibrium::choose_tangent(model, model::pairs_of(state.contact), stage.linear_solver,
                                       stage.dynamics.has_value(), !stage.follower_pressures.empty(),
                                       state.scope.get());
}
} // namespace

Machinery::Machinery(RunContext& context, const Stage& stage, const equilibrium::Dynamics* dynamics,
                     const linear::Constraints& constraints, const model::State& state)
    : choice(tangent_choice(context.model, stage, state)),
      equilibrium(context.model, model::pairs_of(state.contact), constraints, dynamics, choice, context.timings,
                  context.options.threads, !stage.follower_pressures.empty()),
      solver(equilibrium.size(), context.timings, context.model.share ? &context.model.share->ranks() : nullptr,
             context.options.threads),
      collisions(context.model, equilibrium.contact(), stage.limits, stage.follow_paths, context.timings,
                 context.options.threads) {
    for (model::ContactEvaluation& evaluation : equilibrium.contact()) evaluation.pass_over_far_nodes(true);
}

StageRun::StageRun(RunContext& context, const Stage& stage, Progress& progress, StepObserver& observer,
                   const Checkpoint* from)
    : context_(context), stage_(stage), progress_(progress), observer_(observer),
      constraints_(constraints_of(context.model, stage)), dynamics_(stage.dynamics),
      machinery_(std::make_unique<Machinery>(context, stage, dynamics(), constraints_,
                                             change_pairs(context, stage, progress.state))) {
    const model::Model& model = context.model;
    if (from == nullptr) begin_stage(stage, constraints_, progress_);
    if (dynamics_ && (from == nullptr || progress_.state.v.empty()))
        begin_dynamics(context_, stage, constraints_,
                       machinery_->choice.multigrid ? MassSolution::by_conjugate_gradients : MassSolution::by_factors,
                       progress_);
    if (dynamics_) centres_.emplace(model, *dynamics_, constraints_, context.options.threads);
    for (BesideRun* runs : context_.beside) runs->begin_stage(progress_.stage);
    targets_ = times_to_hit(stage, progress_.stage_start);
    if (context.model.general && !progress_.state.scope) {
        const double speed =
            progress_.state.v.empty() ? 0 : largest_distance(progress_.state.v, Field(progress_.state.v.size())).value;
        find_pairs(speed * progress_.dt);
    }
    if (from != nullptr) equilibrium().recall(from->memory);
    keep_stage_once();
}

void StageRun::run() {
    while (progress_.reached < targets_.size()) {
        const long factorised = machinery_->solver.factorisations(), iterated = machinery_->solver.gmres_iterations();
        StepAttempt attempt = prepare();
        keep_attempt_once(attempt);
        if (wants_trial(attempt)) trial(attempt);
        if (attempt.decision.verdict == Verdict::accept) {
            solve(attempt);
            attempt.decision = judge(attempt.evidence, stage_.limits, attempt.dt, repeats_);
        }
        if (attempt.decision.verdict == Verdict::accept && attempt.uncovered > 0) look_farther(attempt);
        if (attempt.decision.reason == Reason::audit) watch(attempt);
        progress_.counts.factorisations += machinery_->solver.factorisations() - factorised;
        progress_.counts.gmres_iterations += machinery_->solver.gmres_iterations() - iterated;
        progress_.counts.paths_followed += machinery_->collisions.take_paths_followed();
        attempts_.push_back(row_of(attempt));
        if (attempt.decision.verdict == Verdict::accept)
            commit(attempt);
        else
            reject(attempt);
    }
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

    if (dynamics_)
        dynamics_->integrator = progress_.impact ? equilibrium::backward_euler() : stage_.dynamics->integrator;
    Field u = state.u;
    equilibrium::StepLoad load = mean_load(context_.model, stage_, constraints_, dynamics(), progress_, attempt.time);
    if (dynamics_)
        for (std::size_t i = 0; i < u.size(); ++i)
            u[i] = dynamics_->integrator.predictor(state.u[i], state.v[i], state.a[i], attempt.dt);
    else if (options.predictor)
        predict(context_.model, constraints_, load.prescribed, u);
    if (dynamics_) attempt.force = load.force;
    if (bounded() && !machinery_->located) machinery_->collisions.begin_step(state);
    machinery_->located = true;
    const double reference = reference_force(context_, stage_, constraints_, state, load, attempt.dt);
    equilibrium().begin_attempt(state, load, attempt.dt);
    attempt.z = equilibrium().unknowns(u, state.contact);
    const Field start = equilibrium().displacements(attempt.z);

    LadderOptions& ladder = attempt.ladder;
    ladder.tolerance = options.tolerance;
    ladder.max_iterations = options.max_iterations;
    ladder.characteristic_length = context_.characteristic_length;
    ladder.reference_force = reference;
    ladder.round_off = context_.round_off_force();
    ladder.farthest = context_.characteristic_length + largest_component(state.u);
    ladder.settles = stage_.limits.inelastic_impacts;
    ladder.last_chance = cannot_be_cut(stage_.limits, attempt.dt, repeats_);
    const bool hard = repeats_ > 0 || ladder.last_chance;
    if (context_.model.nonlinear) {
        ladder.predicted = u;
        ladder.unpredicted = state.u;
    }
    equilibrium().set_reference_force(reference > 0 ? reference : 1);
    if (!dynamics_) // inertia holds what nothing touches
        attempt.forced = starting_statuses(context_, equilibrium().bodies(), state, start, hard, attempt.statuses);
    else
        for (const model::ContactHistory& history : state.contact) attempt.statuses.push_back(history.status);
    if (!dynamics_ && hard && bounded())
        ladder.admissible = [this](const Field& next) {
            StepEvidence evidence;
            machinery_->collisions.add_solution(next, evidence);
            return std::ranges::all_of(evidence.gaps, [&](const GapEvidence& gap) {
                return gap.g1 >= -stage_.limits.allowed_interpenetration * gap.length;
            });
        };
    if (!dynamics_ && options.stabilisation) ladder.stabilisation = stabilisation_options(context_, state, start);
    if (reference == 0) {
        equilibrium::Equilibrium alone(context_.model, model::pairs_of(state.contact), constraints_, dynamics(), {},
                                       context_.timings, options.threads, !stage_.follower_pressures.empty());
        alone.begin_attempt(state, std::move(load), attempt.dt);
        ladder.reference_force = imbalance(alone, attempt.z, attempt.statuses, attempt.forced);
    }
    attempt.reference_force = ladder.reference_force;
    return attempt;
}

bool StageRun::bounded() const {
    return std::isfinite(stage_.limits.allowed_interpenetration) && !progress_.state.contact.empty();
}

bool StageRun::wants_trial(const StepAttempt& attempt) const {
    // the default of statics costs nothing where steps are easy
    const StepLimits& limits = stage_.limits;
    const bool easy = limits.usual_bound && repeats_ == 0 && attempt.proposed >= limits.dt_max * (1 - same_step);
    return bounded() && !attempt.forced && !easy;
}

void StageRun::trial(StepAttempt& attempt) {
    Vector z = attempt.z;
    attempt.result = solve_trial(equilibrium(), machinery_->solver, z, attempt.statuses, attempt.ladder);
    attempt.iterations = attempt.result.iterations;
    if (!attempt.result.converged()) return;
    machinery_->collisions.add_trial(equilibrium().displacements(z), attempt.evidence);
    attempt.evidence.iterations = attempt.iterations;
    attempt.evidence.impact = progress_.impact;
    attempt.decision = judge(attempt.evidence, stage_.limits, attempt.dt, repeats_);
    attempt.z = std::move(z);
    attempt.ladder.reference_force = attempt.result.reference_force;
    attempt.ladder.predicted.clear();
}

void StageRun::solve(StepAttempt& attempt) {
    const model::State& state = progress_.state;
    const auto unpredicted = [&] { return equilibrium().unknowns(state.u, state.contact); };
    attempt.result = climb(equilibrium(), machinery_->solver, attempt.z, unpredicted, attempt.statuses, attempt.forced,
                           attempt.ladder);
    attempt.iterations += attempt.result.iterations;
    const int every = context_.options.reject_every;
    StepEvidence& evidence = attempt.evidence;
    evidence = {};
    evidence.solved = attempt.result.converged();
    evidence.hopeless = attempt.result.adrift >= 0;
    evidence.impact = progress_.impact;
    evidence.iterations = attempt.iterations;
    evidence.residual = attempt.result.residual;
    evidence.forced = every > 0 && (progress_.counts.attempts + 1) % every == 0;
    if (attempt.result.converged()) gather_evidence(attempt);
}

void StageRun::gather_evidence(StepAttempt& attempt) {
    StepEvidence& evidence = attempt.evidence;
    attempt.next = equilibrium().state(attempt.z);
    attempt.next.time = attempt.time;
    if (dynamics_)
        attempt.ledger = advanced(progress_.ledger, context_.model, *dynamics_, equilibrium(), progress_.state,
                                  attempt.next, attempt.force, progress_.impact);
    attempt.not_finite = find_not_finite(equilibrium().contact(), attempt.next, dynamics_ ? &attempt.ledger : nullptr);
    if (attempt.not_finite) {
        attempt.result.outcome = solve::KinsolOutcome::not_finite;
        evidence.solved = false;
    }
    if (bounded()) machinery_->collisions.add_solution(attempt.next.u, evidence);
    evidence.unseen = deepest_unseen(equilibrium().contact());
    if (context_.audit && !attempt.not_finite) {
        const ScopedTimer timer(context_.timings, Part::audit);
        attempt.audit = &context_.audit->examine(attempt.next.u);
        evidence.intrusion = context_.audit->deepest();
        evidence.far =
            farthest_force(context_.model, equilibrium().contact(), attempt.next, stage_.limits.audited_depth);
    }
    if (dynamics_) gather_dynamic_evidence(attempt);
    if (const auto& general = context_.model.general;
        general && !general->covers(*progress_.state.scope, sum(context_.model.X, attempt.next.u)))
        attempt.uncovered = largest_distance(attempt.next.u, progress_.state.u).value;
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
        evidence.velocity_error =
            velocity_error(context_.model, *stage_.dynamics, *centres_, equilibrium().contact(), progress_.state,
                           attempt.next, attempt.dt, std::max(energy_so_far(before), energy_so_far(after)));
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
    if (decision.reason == Reason::solver) row.cause = explain(model, attempt.result, equilibrium(), row);
    if (decision.pair >= 0)
        name_node(model,
                  progress_.state.contact[static_cast<std::size_t>(decision.pair)].pair->slaves().node[decision.slave],
                  row);
    if (decision.intrusion) {
        name_node(model, decision.intrusion->node, row);
        row.cause = in_words(*decision.intrusion, model) + "; " + row.cause;
    }
    if (decision.reason == Reason::distance)
        row.cause = in_words(*attempt.evidence.far,
                             *progress_.state.contact[static_cast<std::size_t>(decision.pair)].pair, model) +
                    "; " + row.cause;
    if (attempt.not_finite) explain(*attempt.not_finite, model, row);
    if (decision.reason == Reason::error && attempt.worst_in_time >= 0) name_node(model, attempt.worst_in_time, row);
    return row;
}

void StageRun::commit(StepAttempt& attempt) {
    if (const auto& share = context_.model.share; share && !share->agree(attempt.next.u))
        throw RunFailure(
            "the processes do not hold the same displacements any more; do they run on processors of one kind?");
    equilibrium().commit();
    if (!context_.beside.empty()) lead(attempt);
    const double moved = context_.model.general ? largest_distance(attempt.next.u, progress_.state.u).value : 0;
    attempt.next.scope = progress_.state.scope;
    progress_.state = attempt.next; // in place: its arrays stay where they are for whoever looks at them
    attempt.next = {};              // not held twice while files are written
    progress_.counts.stabilised_steps += attempt.result.stabilised_solves > 0 ? 1 : 0;
    progress_.counts.held_geometry_steps += attempt.result.held_geometry ? 1 : 0;
    const double left = attempt.result.residual * attempt.result.reference_force;
    const bool raised = attempt.result.reference_force > attempt.reference_force;
    if (equilibrium().rests() || (raised && left > context_.options.tolerance * attempt.reference_force))
        ++progress_.counts.steps_at_round_off;
    if (dynamics_) progress_.ledger = attempt.ledger;
    observer_.attempted(attempts_.back(), equilibrium().records());
    observer_.accepted({progress_.state, equilibrium(), attempt.dt, attempt.iterations, stage_,
                        dynamics_ ? &progress_.ledger : nullptr, attempt.audit});
    refit_patches(context_.model, progress_);
    machinery_->located = false;
    if (const auto& general = context_.model.general) {
        const model::ContactScope& scope = *progress_.state.scope;
        std::vector<model::WatchedNode> watched = scope.watched;
        if (attempt.audit != nullptr) watched = general->watched(watched, attempt.audit->places);
        const Field x = sum(context_.model.X, progress_.state.u);
        if (watched != scope.watched || !general->covers(scope, x, moved) || general->comes_round(scope, x, moved))
            find_pairs(moved, std::move(watched));
    }
    attempts_.clear();
    repeats_ = 0;
    lost_per_second_ = 0;
    progress_.reached += attempt.on_target ? 1 : 0;
    // a step that was short of a target alone keeps its size for the next
    progress_.dt = std::max(attempt.decision.dt, attempt.proposed);
    progress_.impact = attempt.decision.impact;
    observer_.between_steps([this] { return checkpoint(); });
}

void StageRun::lead(const StepAttempt& attempt) {
    solve::KinsolSolver& solver = machinery_->solver;
    std::optional<bool> regular; // linearised when first asked for
    const auto inverse = [&](const Vector& F, Vector& dz) {
        if (!regular) regular = solver.linearise(equilibrium());
        return *regular && solver.solve_linear(F, dz);
    };
    const BesideStep step{
        progress_.state, attempt.next, attempt.z,        equilibrium().statuses(),       equilibrium().contact(),
        attempt.time,    attempt.dt,   progress_.impact, equilibrium().reference_force()};
    for (BesideRun* runs : context_.beside) runs->follow(step, inverse);
    equilibrium().rollback(); // what this needed leaves no trace in the run
}

void StageRun::reject(const StepAttempt& attempt) {
    observer_.attempted(attempts_.back(), equilibrium().records());
    if (attempt.decision.verdict == Verdict::give_up) give_up(attempt);
    equilibrium().rollback();
    const Reason reason = attempt.decision.reason;
    const bool cut = reason != Reason::forced && reason != Reason::reach && reason != Reason::impact;
    if (reason == Reason::closing_energy) lost_per_second_ = attempt.evidence.closing_energy / attempt.dt;
    if (cut) ++repeats_;
    progress_.impact = attempt.decision.impact;
    progress_.dt = cut ? attempt.decision.dt : attempt.proposed;
}

Checkpoint StageRun::checkpoint() const {
    Checkpoint now{progress_, found_pairs(progress_.state, context_.model), {}, {}, {}, {}, equilibrium().memory(), {}};
    if (progress_.state.scope) {
        now.scope_x = progress_.state.scope->x;
        now.scope_margin = progress_.state.scope->margin;
        now.scope_own = progress_.state.scope->own;
        for (const auto& [node, surface] : progress_.state.scope->watched)
            now.watched.insert(now.watched.end(), {node, surface});
    }
    for (const model::ContactHistory& history : progress_.state.contact)
        now.patches.push_back(history.master->refitted_patches());
    return now;
}

void StageRun::install(std::vector<model::ContactHistory> contact, model::ContactScope scope) {
    model::State& state = progress_.state;
    state.contact.resize(context_.model.pairs.size());
    state.contact.insert(state.contact.end(), std::make_move_iterator(contact.begin()),
                         std::make_move_iterator(contact.end()));
    state.scope = std::make_shared<const model::ContactScope>(std::move(scope));
    const auto condensed = equilibrium().kept_condensation();
    machinery_ = nullptr; // its memory first
    machinery_ = std::make_unique<Machinery>(context_, stage_, dynamics(), constraints_, state);
    equilibrium().go_on_from(condensed);
}

void StageRun::find_pairs(double expected, std::vector<model::WatchedNode> watched) {
    const ScopedTimer timer(context_.timings, Part::search);
    const model::State& state = progress_.state;
    const model::GeneralContact& general = *context_.model.general;
    model::ContactScope scope = general.scope_at(sum(context_.model.X, state.u), expected, std::move(watched));
    const std::vector<model::ContactHistory> before = of_general_contact(state, context_.model);
    std::vector<model::ContactHistory> found = general.near(scope, before);
    const auto alike = [](const model::ContactHistory& a, const model::ContactHistory& b) {
        return model::GeneralContact::alike(*a.pair, *b.pair);
    };
    if (std::ranges::equal(found, before, alike)) {
        progress_.state.scope = std::make_shared<const model::ContactScope>(std::move(scope));
        if (machinery_->choice == tangent_choice(context_.model, stage_, state)) return; // as it would be made anew
        scope = *state.scope;
    }
    install(std::move(found), std::move(scope));
}

void StageRun::look_farther(StepAttempt& attempt) {
    const model::State& state = progress_.state;
    const model::GeneralContact& general = *context_.model.general;
    model::ContactScope scope =
        general.scope_at(sum(context_.model.X, state.u), attempt.uncovered, state.scope->watched);
    const std::vector<model::ContactHistory> before = of_general_contact(state, context_.model);
    std::vector<model::ContactHistory> found = general.near(scope, before);
    const auto same = [](const model::ContactHistory& a, const model::ContactHistory& b) {
        return a.pair->name() == b.pair->name() && a.pair->slaves().node == b.pair->slaves().node;
    };
    if (std::ranges::equal(found, before, same)) return;
    install(std::move(found), std::move(scope));
    attempt.decision = {};
    attempt.decision.verdict = Verdict::retry;
    attempt.decision.reason = Reason::reach;
    attempt.decision.impact = progress_.impact;
    attempt.decision.dt = attempt.dt;
    attempt.decision.value = attempt.uncovered;
    attempt.decision.cause = "bodies moved by " + number(attempt.uncovered) + " m, to others that were not near";
}

void StageRun::watch(StepAttempt& attempt) {
    const auto& general = context_.model.general;
    if (!general || attempt.audit == nullptr) return;
    const model::State& state = progress_.state;
    std::vector<model::WatchedNode> watched = general->watched(state.scope->watched, attempt.audit->places);
    if (watched == state.scope->watched) return;
    model::ContactScope scope =
        general->scope_at(sum(context_.model.X, state.u), attempt.uncovered, std::move(watched));
    std::vector<model::ContactHistory> found = general->near(scope, of_general_contact(state, context_.model));
    if (std::ranges::includes(state.scope->watched, scope.watched)) return; // the others are not near yet
    install(std::move(found), std::move(scope));
    attempt.decision.verdict = Verdict::retry;
    attempt.decision.reason = Reason::reach;
    attempt.decision.impact = progress_.impact;
    attempt.decision.dt = attempt.dt;
    attempt.decision.cause = "contact watches the place from now on";
}

void StageRun::give_up(const StepAttempt& attempt) {
    const FailedAttempt failed{context_.model, stage_,         progress_.state,  attempt.z,
                               attempt.result, attempt.ladder, attempt.decision, attempts_};
    const Attempt& row = attempts_.back();
    PostMortem found = examine(failed, equilibrium());
    found.message = "stage '" + stage_.name + "', step of " + number(row.dt) + " s to time " + number(row.time) + " s" +
                    (attempt.result.adrift >= 0 ? "" : ", the smallest allowed,") + " failed. " + row.cause;
    model::State state = equilibrium().state(attempt.z);
    state.time = row.time;
    const FailedIterate iterate{failed, state, equilibrium()};
    observer_.gave_up(found, &iterate);
    throw RunFailure(found.message);
}

} // namespace osculate::time
