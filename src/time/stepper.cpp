#include "osculate/time/stepper.hpp"

#include "osculate/core/error.hpp"
#include "osculate/time/collision_check.hpp"
#include "osculate/time/finite_check.hpp"
#include "osculate/time/post_mortem.hpp"
#include "time/number.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace osculate::time {

using contact::Status;
using model::Constraints;

namespace {
bool touches(const model::State& state) {
    return std::ranges::any_of(state.contact, [](const model::ContactHistory& pair) {
        return std::ranges::any_of(pair.status, contact::is_closed);
    });
}

/// Masses that contact forces accelerate, and the directions in which nothing holds their bodies.
struct CentreMasses {
    std::vector<std::size_t> slave, master; ///< (pairs) bodies
    std::vector<double> mass;               ///< (bodies) kg
    std::vector<Eigen::Array<bool, 3, 1>> free;

    CentreMasses(const model::Model& model, const Dynamics& dynamics, const Constraints& constraints, int threads)
        : mass(model.bodies.size(), 0.0), free(model.bodies.size(), Eigen::Array<bool, 3, 1>::Constant(true)) {
        std::vector<Vec3> sums(model.X.size(), Vec3::Zero());
        model.mass(dynamics.lumped_mass).multiply_add(std::vector<Vec3>(sums.size(), Vec3::UnitX()), sums, threads);
        constexpr double across = 1e-6; // of a unit vector: round-off of a support's axes
        for (std::size_t b = 0; b < model.bodies.size(); ++b)
            for (Index n = 0; n < model.bodies[b].nodes(); ++n) {
                const Index node = model.bodies[b].first_node + n;
                mass[b] += sums[node].x();
                for (int k = 0; k < 3; ++k)
                    if (constraints.constraint(node, k) != nullptr)
                        free[b] = free[b] && constraints.frame(node).col(k).array().abs() < across;
            }
        const auto owner = [&](Index node) {
            std::size_t b = 0;
            while (b + 1 < model.bodies.size() && model.bodies[b + 1].first_node <= node) ++b;
            return b;
        };
        for (const auto& pair : model.pairs) {
            slave.push_back(owner(pair->slaves().node.front()));
            master.push_back(owner(pair->master_nodes().front()));
        }
    }
};

/// What the energy of a step in which something touches has risen by beyond external work, of the kinetic and strain energy
/// at its start. Contact may feed it through its own work, and through the integrator: a force that ends with a node's
/// release acts on, in the formulas that take it as linear over the step, along the way that opens the gap.
double energy_from_nowhere(const Ledger& before, const Ledger& after) {
    const auto free = [](const Ledger& ledger) { return ledger.kinetic + ledger.strain - ledger.external; };
    const double energy = before.kinetic + before.strain;
    return energy > 0 ? std::max({0.0, free(after) - free(before), after.contact - before.contact}) / energy : 0;
}

/// All energy there has been up to a ledger's state, as far as contact and integrator have not brought it in, J.
double energy_so_far(const Ledger& ledger) {
    return ledger.kinetic + ledger.strain + ledger.friction + ledger.damping + std::max(0.0, ledger.algorithmic) +
           std::max(0.0, -ledger.contact);
}

/// StepEvidence::closing_energy: a force at the end of a step has done work along the whole gap that it has closed.
double closing_energy(const Ledger& before, const Ledger& after) {
    const double energy = std::max(energy_so_far(before), energy_so_far(after));
    return energy > 0 ? std::max(0.0, before.contact - after.contact) / energy : 0;
}

/// StepEvidence::velocity_error, of an energy. From contact forces and not from accelerations: those of a rule that damps
/// nothing alternate for ever after a shock.
double velocity_error(const model::Model& model, const Dynamics& dynamics, const CentreMasses& masses,
                      const model::State& from, const model::State& to, double dt, double energy) {
    if (!(energy > 0)) return 0;
    std::vector<Vec3> change(model.bodies.size(), Vec3::Zero()); // of the force on each body, N
    for (std::size_t p = 0; p < model.pairs.size(); ++p) {
        Vec3 sum = Vec3::Zero();
        for (std::size_t j = 0; j < to.contact[p].lambda.size(); ++j)
            sum += to.contact[p].lambda[j] - from.contact[p].lambda[j];
        change[masses.slave[p]] += sum;
        change[masses.master[p]] -= sum;
    }
    double twice = 0;
    for (std::size_t b = 0; b < change.size(); ++b)
        for (int k = 0; k < 3; ++k)
            if (masses.free[b](k) && masses.mass[b] > 0) twice += change[b](k) * change[b](k) / masses.mass[b];
    return dynamics.integrator.error * dt * std::sqrt(twice / (2 * energy));
}

/// Ends of the stage's equal steps and corners of its courses, ascending.
std::vector<double> times_to_hit(const Stage& stage, double t_start) {
    std::vector<double> corners;
    for (const Course& course : stage.courses)
        corners.insert(corners.end(), course.corners.begin(), course.corners.end());
    std::vector<double> times = corners_between(std::move(corners), t_start, stage.duration, stage.steps);
    const double step = stage.duration / stage.steps;
    for (int k = 1; k <= stage.steps; ++k) times.push_back(t_start + k * step);
    std::ranges::sort(times);
    return times;
}

/// StepEvidence::unseen.
GapEvidence deepest_unseen(const model::ContactEvaluations& contact) {
    GapEvidence deepest;
    for (std::size_t p = 0; p < contact.size(); ++p) {
        const model::ContactPair& pair = contact[p].pair();
        for (Index j = 0; j < pair.size(); ++j) {
            const double gap = contact[p].unseen_gap(j);
            if (!(gap < 0)) continue;
            const double length = pair.surface().facet_size(contact[p].facets()[j]);
            if (deepest.pair >= 0 && gap / length >= deepest.g1 / deepest.length) continue;
            deepest = {0, gap, static_cast<Index>(p), j, length};
        }
    }
    return deepest;
}

} // namespace

Stepper::Stepper(const model::Model& model, std::vector<Stage> stages, StepperOptions options, Timings& timings)
    : model_(model), stages_(std::move(stages)), options_(options), timings_(timings) {
    state_.u.assign(model.X.size(), Vec3::Zero());
    for (const auto& pair : model.pairs) state_.contact.push_back(pair->initial_history());
    Vec3 low = model.X.front(), high = low;
    for (const Vec3& X : model.X) {
        low = low.cwiseMin(X);
        high = high.cwiseMax(X);
    }
    characteristic_length_ = (high - low).norm();
    largest_stiffness_ = model::largest_stiffness(model);
    if (!options_.audit) return;
    const ScopedTimer timer(timings_, Part::audit);
    audit_ = std::make_unique<Audit>(model);
}

double Stepper::end_time() const {
    double time = 0;
    for (const Stage& stage : stages_) time += stage.duration;
    return time;
}

void Stepper::run(StepObserver& observer) {
    const std::unique_ptr<const Checkpoint> from = std::move(resumed_);
    for (std::size_t s = from ? from->stage : 0; s < stages_.size(); ++s) {
        const Stage& stage = stages_[s];
        const Checkpoint* within = from && s == from->stage ? from.get() : nullptr;
        const double t_start = within != nullptr ? within->stage_start : state_.time;
        try {
            run_stage(stage, observer, within);
        } catch (const LoadNotFinite& failure) {
            observer.gave_up(examine(failure, model_, stage, t_start, state_.time), nullptr);
            throw;
        }
    }
}

void Stepper::resume(Checkpoint checkpoint) {
    if (const std::string what = misfit(checkpoint, model_, stages_.size()); !what.empty())
        throw RunFailure("the checkpoint does not fit the scene: " + what);
    state_ = checkpoint.state;
    for (std::size_t p = 0; p < model_.pairs.size(); ++p) {
        const model::ContactPair& pair = *model_.pairs[p];
        auto& master = state_.contact[p].master = pair.master();
        if (!checkpoint.patches[p].empty()) master = master->refitted(checkpoint.patches[p]);
        if (!master) throw RunFailure("the checkpoint does not fit the scene: patches of pair '" + pair.name() + "'");
    }
    ledger_ = checkpoint.ledger;
    moved_ = checkpoint.moved;
    attempts_ = checkpoint.attempts;
    stabilised_steps_ = checkpoint.stabilised_steps;
    steps_at_round_off_ = checkpoint.steps_at_round_off;
    factorisations_ = checkpoint.factorisations;
    gmres_iterations_ = checkpoint.gmres_iterations;
    refreshed_patches_ = checkpoint.refreshed_patches;
    paths_followed_ = checkpoint.paths_followed;
    resumed_ = std::make_unique<Checkpoint>(std::move(checkpoint));
}

double Stepper::local_error(const Dynamics& dynamics, const Constraints& constraints, const std::vector<Vec3>& a,
                            double dt, Index& worst) const {
    const model::BlockMatrix& M = model_.mass(dynamics.lumped_mass);
    double largest = 0;
    for (Index i = 0; i < model_.nodes(); ++i) {
        // nothing ties down the acceleration of a node without mass; that of a held direction is given
        bool massless = true;
        for (Index k = M.row_begin(i); k < M.row_end(i) && massless; ++k) massless = M.block(k).isZero(0);
        if (massless) continue;
        Vec3 change = constraints.to_local(i, a[i] - state_.a[i]);
        for (int k = 0; k < 3; ++k)
            if (constraints.constraint(i, k) != nullptr) change(k) = 0;
        const double error = dynamics.integrator.local_error(change, Vec3::Zero(), dt);
        if (error > largest || worst < 0) worst = i;
        largest = std::max(largest, error);
    }
    return largest;
}

void Stepper::refresh_patches() {
    std::vector<Vec3> x;
    for (std::size_t p = 0; p < model_.pairs.size(); ++p) {
        std::shared_ptr<const contact::MasterSurface>& master = state_.contact[p].master;
        if (!master->refits()) continue;
        if (x.empty())
            for (std::size_t i = 0; i < model_.X.size(); ++i) x.push_back(model_.X[i] + state_.u[i]);
        const auto refitted = master->refitted(model_.pairs[p]->vertices(x));
        if (!refitted) continue;
        refreshed_patches_ += refitted->refits_done() - master->refits_done();
        master = refitted;
    }
}

void Stepper::start_motion(const Stage& stage, const Constraints& constraints, StepLoad load) {
    // a later one, after statics, starts at rest
    state_.v = moved_ ? std::vector<Vec3>(model_.X.size(), Vec3::Zero()) : model_.initial_velocity;
    moved_ = true;
    for (Index node = 0; node < model_.nodes(); ++node) { // what holds a body does not move with it
        Vec3 v = constraints.to_local(node, state_.v[node]);
        for (int k = 0; k < 3; ++k)
            if (const auto* c = constraints.constraint(node, k); c != nullptr && !c->driven) v(k) = 0;
        state_.v[node] = constraints.to_global(node, v);
    }
    add_follower_forces(load.pressures, model_, state_.u, load.force);
    find_initial_acceleration(stage, constraints, load.force);
    ledger_ = opened(model_, *stage.dynamics, state_);
}

Attempt Stepper::diary(const Decision& decision, const LadderResult& result, const Equilibrium& equilibrium,
                       double time, double dt, int iterations) {
    Attempt attempt;
    attempt.attempt = ++attempts_;
    attempt.time = time;
    attempt.dt = dt;
    attempt.iterations = iterations;
    attempt.verdict = decision.verdict;
    attempt.reason = decision.reason;
    attempt.value = decision.value;
    attempt.lambda = decision.lambda;
    attempt.cause = decision.cause;
    if (decision.reason == Reason::solver) attempt.cause = explain(model_, result, equilibrium, attempt);
    if (decision.pair >= 0) name_node(model_, model_.pairs[decision.pair]->slaves().node[decision.slave], attempt);
    if (decision.intrusion) {
        name_node(model_, decision.intrusion->node, attempt);
        attempt.cause = in_words(*decision.intrusion, model_) + "; " + attempt.cause;
    }
    return attempt;
}

void Stepper::run_stage(const Stage& stage, StepObserver& observer, const Checkpoint* from) {
    const Constraints constraints(model_.nodes(), stage.constraints);
    const Dynamics* dynamics = stage.dynamics ? &*stage.dynamics : nullptr;
    Equilibrium equilibrium(model_, constraints, dynamics, timings_, options_.threads,
                            !stage.follower_pressures.empty(), options_.linear_solver);
    solve::KinsolSolver solver(equilibrium.size(), timings_);
    std::vector<Vec3> prescribed_start(model_.X.size());
    for (Index node = 0; node < model_.nodes() && from == nullptr; ++node)
        prescribed_start[node] = constraints.to_local(node, state_.u[node]);
    if (from != nullptr) prescribed_start = from->displacement_start;

    if (dynamics != nullptr && state_.v.empty())
        start_motion(stage, constraints, load_at(stage, constraints, prescribed_start, 0));

    std::optional<CentreMasses> centres;
    if (dynamics != nullptr) centres.emplace(model_, *dynamics, constraints, options_.threads);
    const double t_start = from != nullptr ? from->stage_start : state_.time, step = stage.duration / stage.steps;
    const bool controlled = std::isfinite(stage.limits.allowed_interpenetration) && !model_.pairs.empty();
    double dt = step; // not end - begin: round-off would make every step another one
    int repeats = 0;
    std::vector<Attempt> attempts; // of one step
    double lost_per_second = 0;    // by closing gaps, in the step's last attempt that was cut for it
    CollisionCheck collisions(model_, equilibrium.contact(), stage.limits, stage.follow_paths, timings_,
                              options_.threads);
    const std::vector<double> targets = times_to_hit(stage, t_start);
    std::size_t reached = 0;
    if (from != nullptr) {
        reached = from->reached;
        dt = from->dt;
        equilibrium.recall(from->memory);
    }
    const auto checkpoint = [&] {
        Checkpoint now{static_cast<std::size_t>(&stage - stages_.data()),
                       t_start,
                       prescribed_start,
                       reached,
                       dt,
                       state_,
                       ledger_,
                       moved_,
                       attempts_,
                       stabilised_steps_,
                       steps_at_round_off_,
                       factorisations_,
                       gmres_iterations_,
                       refreshed_patches_,
                       paths_followed_,
                       equilibrium.memory(),
                       {}};
        for (const model::ContactHistory& history : state_.contact)
            now.patches.push_back(history.master->refitted_patches());
        return now;
    };
    while (reached < targets.size()) {
        const FittedStep fit = fit_to(state_.time, dt, std::span(targets).subspan(reached));
        const double proposed = dt, time = fit.time;
        dt = fit.dt;

        StepLoad load = load_at(stage, constraints, prescribed_start, time - t_start);
        std::vector<Vec3> u = state_.u;
        if (dynamics != nullptr) {
            const StepLoad before = load_at(stage, constraints, prescribed_start, state_.time - t_start);
            const double alpha = dynamics->integrator.alpha_f;
            for (std::size_t i = 0; i < u.size(); ++i) {
                load.force[i] = (1 - alpha) * load.force[i] + alpha * before.force[i];
                u[i] = dynamics->integrator.predictor(state_.u[i], state_.v[i], state_.a[i], dt);
            }
            for (std::size_t p = 0; p < load.pressures.size(); ++p) load.pressures[p].start = before.pressures[p].end;
        } else if (options_.predictor) {
            predict(constraints, load.prescribed, u);
        }
        if (controlled && repeats == 0) collisions.begin_step(state_);
        equilibrium.begin_attempt(state_, load, dt);
        Vector z = equilibrium.unknowns(u, state_.contact);
        const Vector unpredicted = equilibrium.unknowns(state_.u, state_.contact);
        LadderOptions ladder{options_.tolerance,
                             options_.max_iterations,
                             characteristic_length_,
                             reference_force(stage, load, equilibrium, dt),
                             round_off_force(),
                             characteristic_length_ + largest_displacement(),
                             {},
                             {}};
        if (model_.finite_strain) {
            ladder.predicted = u;
            ladder.unpredicted = state_.u;
        }
        Statuses statuses;
        equilibrium.set_reference_force(ladder.reference_force > 0 ? ladder.reference_force : 1);
        bool forced = false;
        if (dynamics == nullptr) // inertia holds what nothing touches
            forced = starting_statuses(equilibrium, z, statuses);
        else
            for (const model::ContactHistory& history : state_.contact) statuses.push_back(history.status);
        if (dynamics == nullptr && options_.stabilisation)
            ladder.stabilisation = stabilisation_options(equilibrium.contact());
        ladder.last_chance = cannot_be_cut(stage.limits, dt, repeats);
        if (ladder.reference_force == 0) ladder.reference_force = imbalance(equilibrium, z, statuses, forced);
        const std::vector<Vec3> force = dynamics != nullptr ? load.force : std::vector<Vec3>{};
        equilibrium.begin_attempt(state_, std::move(load), dt);
        const long factorised = solver.factorisations(), iterated = solver.gmres_iterations();

        // trial with the statuses known at the start; its solution is where the equilibrium with contact starts from
        StepEvidence evidence;
        Decision decision;
        LadderResult result;
        std::optional<NotFinite> not_finite;
        int iterations = 0;
        Index worst_in_time = -1;
        const contact::AuditResult* found = nullptr;
        // the default of statics costs nothing where steps are easy
        constexpr double same_step = 1e-6;
        const bool easy = stage.limits.usual_bound && repeats == 0 && proposed >= stage.limits.dt_max * (1 - same_step);
        if (controlled && !forced && !easy) {
            Vector trial = z;
            result = solve_trial(equilibrium, solver, trial, statuses, ladder);
            iterations = result.iterations;
            if (result.converged()) {
                collisions.add_trial(equilibrium.state(trial).u, evidence);
                evidence.iterations = iterations;
                decision = judge(evidence, stage.limits, dt, repeats);
                z = std::move(trial);
                ladder.reference_force = result.reference_force;
                ladder.predicted.clear();
            }
        }
        model::State next;
        Ledger ledger;
        if (decision.verdict == Verdict::accept) {
            result = climb(equilibrium, solver, z, unpredicted, statuses, forced, ladder);
            iterations += result.iterations;
            evidence = {};
            evidence.solved = result.converged();
            evidence.hopeless = result.adrift >= 0;
            evidence.iterations = iterations;
            evidence.residual = result.residual;
            evidence.forced = options_.reject_every > 0 && (attempts_ + 1) % options_.reject_every == 0;
            if (result.converged()) {
                next = equilibrium.state(z);
                next.time = time;
                if (dynamics != nullptr)
                    ledger = advanced(ledger_, model_, *dynamics, equilibrium, state_, next, force);
                not_finite = find_not_finite(equilibrium.contact(), next, dynamics != nullptr ? &ledger : nullptr);
                if (not_finite) {
                    result.outcome = solve::KinsolOutcome::not_finite;
                    evidence.solved = false;
                }
                if (controlled) collisions.add_solution(next.u, evidence);
                evidence.unseen = deepest_unseen(equilibrium.contact());
                if (audit_ && !not_finite) {
                    const ScopedTimer timer(timings_, Part::audit);
                    found = &audit_->examine(next.u);
                    evidence.intrusion = audit_->deepest();
                }
                if (dynamics != nullptr) {
                    if (std::isfinite(stage.limits.error_tolerance))
                        evidence.local_error = local_error(*dynamics, constraints, next.a, dt, worst_in_time);
                    if (std::isfinite(stage.limits.velocity_error) && !not_finite)
                        evidence.velocity_error =
                            velocity_error(model_, *dynamics, *centres, state_, next, dt,
                                           std::max(energy_so_far(ledger_), energy_so_far(ledger)));
                    if (std::isfinite(stage.limits.closing_energy) && !not_finite)
                        evidence.closing_energy = closing_energy(ledger_, ledger);
                    // a node with mass loses the same however short the step in which it lands
                    evidence.closes_anyhow = lost_per_second > 0 && evidence.closing_energy > lost_per_second * dt;
                    if (touches(state_) || touches(next)) evidence.energy_jump = energy_from_nowhere(ledger_, ledger);
                }
            }
            decision = judge(evidence, stage.limits, dt, repeats);
        }
        factorisations_ += solver.factorisations() - factorised;
        gmres_iterations_ += solver.gmres_iterations() - iterated;
        paths_followed_ += collisions.take_paths_followed();

        Attempt attempt = diary(decision, result, equilibrium, time, dt, iterations);
        if (not_finite) explain(*not_finite, model_, attempt);
        if (decision.reason == Reason::error && worst_in_time >= 0) name_node(model_, worst_in_time, attempt);
        attempts.push_back(attempt);
        if (decision.verdict == Verdict::accept) {
            equilibrium.commit();
            state_ = next; // in place: its arrays stay where they are for whoever looks at them
            stabilised_steps_ += result.stabilised_solves > 0 ? 1 : 0;
            steps_at_round_off_ += equilibrium.rests() ? 1 : 0;
            if (dynamics != nullptr) ledger_ = ledger;
            observer.attempted(attempt, equilibrium.records());
            observer.accepted(
                {state_, equilibrium, dt, iterations, stage, dynamics != nullptr ? &ledger_ : nullptr, found});
            refresh_patches();
            attempts.clear();
            repeats = 0;
            lost_per_second = 0;
            reached += fit.on_target ? 1 : 0;
            dt = std::max(decision.dt, proposed); // a step that was short of a target alone keeps its size for the next
            observer.between_steps(checkpoint);
            continue;
        }
        observer.attempted(attempt, equilibrium.records());
        if (decision.verdict == Verdict::give_up) {
            const FailedAttempt failed{model_, stage, state_, z, result, ladder, decision, attempts};
            give_up(failed, equilibrium, observer);
        }
        equilibrium.rollback();
        if (decision.reason == Reason::closing_energy) lost_per_second = evidence.closing_energy / dt;
        if (decision.reason != Reason::forced) ++repeats;
        dt = decision.reason == Reason::forced ? proposed : decision.dt;
    }
}

void Stepper::give_up(const FailedAttempt& failed, Equilibrium& equilibrium, StepObserver& observer) const {
    const Attempt& attempt = failed.attempts.back();
    PostMortem found = examine(failed, equilibrium);
    found.message = "stage '" + failed.stage.name + "', step of " + number(attempt.dt) + " s to time " +
                    number(attempt.time) + " s" + (failed.result.adrift >= 0 ? "" : ", the smallest allowed,") +
                    " failed. " + attempt.cause;
    model::State state = equilibrium.state(failed.z);
    state.time = attempt.time;
    const FailedIterate iterate{state, equilibrium};
    observer.gave_up(found, &iterate);
    throw RunFailure(found.message);
}

} // namespace osculate::time
