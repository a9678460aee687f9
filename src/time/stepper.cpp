#include "osculate/time/stepper.hpp"

#include "osculate/core/error.hpp"
#include "osculate/time/collision_check.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

namespace osculate::time {

using contact::Status;
using model::Constraints;

namespace {
std::string number(double value) {
    std::ostringstream text;
    text << value;
    return text.str();
}

/// What a step's energy has risen by beyond external work, of the kinetic and strain energy at its start. Contact may feed
/// it through its own work, and through the integrator: a force that ends with a node's release acts on, in the formulas
/// that take it as linear over the step, along the way that opens the gap.
double energy_from_nowhere(const Ledger& before, const Ledger& after) {
    const auto free = [](const Ledger& ledger) { return ledger.kinetic + ledger.strain - ledger.external; };
    const double energy = before.kinetic + before.strain;
    return energy > 0 ? std::max({0.0, free(after) - free(before), after.contact - before.contact}) / energy : 0;
}

} // namespace

Stepper::Stepper(model::Model& model, std::vector<Stage> stages, StepperOptions options, Timings& timings)
    : model_(model), stages_(std::move(stages)), options_(options), timings_(timings) {
    state_.u.assign(model.X.size(), Vec3::Zero());
    for (const auto& pair : model.pairs) state_.contact.push_back(pair->initial_history());
    Vec3 low = model.X.front(), high = low;
    for (const Vec3& X : model.X) {
        low = low.cwiseMin(X);
        high = high.cwiseMax(X);
    }
    characteristic_length_ = (high - low).norm();
}

double Stepper::end_time() const {
    double time = 0;
    for (const Stage& stage : stages_) time += stage.duration;
    return time;
}

void Stepper::run(StepObserver& observer) {
    for (const Stage& stage : stages_) run_stage(stage, observer);
}

StepLoad Stepper::load_at(const Stage& stage, const Constraints& constraints, const std::vector<Vec3>& prescribed_start,
                          double elapsed) const {
    const double ramp = stage.ramp ? elapsed / stage.duration : 1;
    StepLoad load;
    load.force.resize(model_.X.size());
    for (std::size_t i = 0; i < load.force.size(); ++i)
        load.force[i] = stage.force_start[i] + ramp * (stage.force_end[i] - stage.force_start[i]);
    std::vector<double> value;
    for (const Course& course : stage.courses) {
        value.push_back(course.at(elapsed));
        if (!std::isfinite(value.back()))
            throw RunFailure("stage '" + stage.name + "': " + course.name + " is " + number(value.back()) + " at " +
                             number(elapsed) + " s after the stage's start");
    }
    for (const CourseForce& part : stage.course_forces)
        for (std::size_t i = 0; i < load.force.size(); ++i) load.force[i] += value[part.course] * part.pattern[i];
    for (const FollowerPressure& pressure : stage.follower_pressures) {
        const double now =
            pressure.course >= 0 ? value[pressure.course] : pressure.start + ramp * (pressure.end - pressure.start);
        load.pressures.push_back({&pressure.facets, now, now});
    }
    load.prescribed = prescribed_start;
    for (Index node = 0; node < model_.nodes(); ++node)
        for (int k = 0; k < 3; ++k)
            if (const auto* c = constraints.constraint(node, k); c != nullptr && c->driven) {
                const double start = prescribed_start[node](k);
                load.prescribed[node](k) =
                    c->course >= 0 ? c->target * value[c->course] : start + ramp * (c->target - start);
            }
    return load;
}

void Stepper::predict(const Constraints& constraints, const std::vector<Vec3>& prescribed, std::vector<Vec3>& u) const {
    for (const model::Body& body : model_.bodies) {
        Vec3 centre = Vec3::Zero();
        for (const Vec3& X : body.mesh.nodes) centre += X / static_cast<double>(body.nodes());
        double size = 0;
        for (const Vec3& X : body.mesh.nodes) size = std::max(size, (X - centre).norm());

        // increments d . (t + w x r) = delta of every held component; r in units of the body's size
        std::vector<Eigen::Matrix<double, 1, 6>> rows;
        std::vector<double> increments;
        for (Index i = 0; i < body.nodes(); ++i) {
            const Index node = body.first_node + i;
            const Vec3 now = constraints.to_local(node, u[node]);
            for (int k = 0; k < 3; ++k) {
                if (constraints.constraint(node, k) == nullptr) continue;
                const Vec3 d = constraints.frame(node).col(k), r = (body.mesh.nodes[i] + u[node] - centre) / size;
                rows.emplace_back();
                rows.back() << d.transpose(), r.cross(d).transpose();
                increments.push_back(prescribed[node](k) - now(k));
            }
        }
        double largest = 0;
        for (const double delta : increments) largest = std::max(largest, std::abs(delta));
        if (largest == 0) continue;
        Eigen::Matrix<double, Eigen::Dynamic, 6> M(static_cast<Index>(rows.size()), 6);
        for (std::size_t i = 0; i < rows.size(); ++i) M.row(static_cast<Index>(i)) = rows[i];
        const Vector delta = Eigen::Map<const Vector>(increments.data(), static_cast<Index>(increments.size()));
        const Vector motion = M.completeOrthogonalDecomposition().solve(delta); // the smallest that fits
        constexpr double fit = 1e-8;
        if ((M * motion - delta).cwiseAbs().maxCoeff() > fit * largest) continue;
        const Vec3 t = motion.head<3>(), w = motion.tail<3>() / size;
        for (Index i = 0; i < body.nodes(); ++i) {
            Vec3& ui = u[body.first_node + i];
            ui += t + w.cross(Vec3(body.mesh.nodes[i] + ui - centre));
        }
    }
}

bool Stepper::starting_statuses(Equilibrium& equilibrium, const Vector& z, Statuses& statuses) const {
    statuses.clear();
    bool any = false;
    for (const auto& history : state_.contact) {
        statuses.push_back(history.status);
        any = any || std::none_of(history.status.begin(), history.status.end(), contact::is_closed);
    }
    if (!any) return false;

    Vector F(z.size());
    equilibrium.set_statuses(statuses, StatusRule::frozen, false);
    if (equilibrium.residual(z.data(), F.data()) == solve::NonlinearProblem::Verdict::shorten) return false;
    bool forced = false;
    for (std::size_t p = 0; p < statuses.size(); ++p) {
        const model::ContactTerm& pair = *model_.pairs[p];
        if (std::any_of(statuses[p].begin(), statuses[p].end(), contact::is_closed)) continue;
        // "closed where g < 0" would start a smooth master, which leaves a small gap everywhere, without any support
        double least = std::numeric_limits<double>::max();
        for (Index j = 0; j < pair.size(); ++j)
            if (pair.point(j).found) least = std::min(least, pair.point(j).gap);
        for (Index j = 0; j < pair.size(); ++j) {
            if (!pair.point(j).found) continue;
            const double tolerance = pair.options().closing_tolerance * pair.surface().facet_size(pair.point(j).facet);
            if (least > tolerance || pair.point(j).gap > std::max(least, 0.0) + tolerance) continue;
            statuses[p][j] = pair.options().friction > 0 ? Status::stick : Status::glide;
            forced = true;
        }
    }
    return forced;
}

void Stepper::find_initial_acceleration(const Stage& stage, const Constraints& constraints,
                                        const std::vector<Vec3>& force) {
    const Dynamics& dynamics = *stage.dynamics;
    const model::BlockMatrix& M = model_.mass(dynamics.lumped_mass);
    const auto n = static_cast<std::size_t>(model_.nodes());
    const std::vector<Vec3> own = body_forces(model_, dynamics, state_, options_.threads);
    std::vector<Vec3> f = force, x = model_.X;
    for (std::size_t i = 0; i < n; ++i) {
        f[i] -= own[i];
        x[i] += state_.u[i];
    }
    for (std::size_t p = 0; p < model_.pairs.size(); ++p) {
        model::ContactTerm& pair = *model_.pairs[p];
        pair.begin_step(x, state_.contact[p], timings_, options_.threads);
        pair.evaluate(x, timings_, options_.threads);
        for (Index j = 0; j < pair.size(); ++j) {
            const Vec3& lambda = state_.contact[p].lambda[j];
            f[pair.slaves().node[j]] += lambda;
            for (std::size_t i = 0; i < pair.point_nodes(j).size(); ++i)
                f[pair.point_nodes(j)[i]] += pair.master_force(j, static_cast<Index>(i), lambda);
        }
    }
    model::PenaltyStiffness free_mass(constraints, M);
    free_mass.set_springs({});
    const auto solver = solve::make_cholesky();
    // nodes without mass have no acceleration of their own
    solve::SparseMatrix matrix = free_mass.matrix();
    const double heaviest = *std::max_element(matrix.value.begin(), matrix.value.end());
    std::vector<char> empty(static_cast<std::size_t>(constraints.equations()), 0);
    for (solve::SparseIndex i = 0; i < matrix.rows(); ++i)
        for (solve::SparseIndex k = matrix.row_start[i]; k < matrix.row_start[i + 1]; ++k)
            if (matrix.column[k] == i && matrix.value[k] == 0) {
                matrix.value[k] = heaviest;
                empty[static_cast<std::size_t>(i)] = 1;
            }
    if (solver->factorise(matrix) != solve::FactorStatus::ok)
        throw RunFailure("stage '" + stage.name + "': the mass matrix is not positive definite");
    Vector right(constraints.equations()), a(constraints.equations());
    constraints.gather(f, right.data());
    for (Index i = 0; i < right.size(); ++i)
        if (empty[static_cast<std::size_t>(i)] != 0) right(i) = 0;
    solver->solve(right.data(), a.data());
    state_.a.assign(n, Vec3::Zero());
    constraints.scatter(a.data(), std::vector<Vec3>(n, Vec3::Zero()), state_.a);
}

double Stepper::reference_force(const Stage& stage, const StepLoad& load, const Equilibrium& equilibrium,
                                double dt) const {
    const auto norm = [](const std::vector<Vec3>& f) {
        double sum = 0;
        for (const Vec3& v : f) sum += v.squaredNorm();
        return std::sqrt(sum);
    };
    std::vector<Vec3> internal = model::internal_force(model_, state_.u, options_.threads);
    std::vector<Vec3> external = load.force;
    std::vector<FollowerLoad> pressures = load.pressures;
    for (FollowerLoad& pressure : pressures) pressure.start = pressure.end;
    add_follower_forces(pressures, model_, state_.u, external);
    double carried = std::max(norm(external), norm(internal));
    if (stage.dynamics) {
        // a thousandth of the force that would stop every motion within the step
        constexpr double share = 1e-3;
        const model::BlockMatrix& M = model_.mass(stage.dynamics->lumped_mass);
        for (const auto& [motion, factor] : {std::pair{&state_.a, 1.0}, std::pair{&state_.v, share / dt}}) {
            std::fill(internal.begin(), internal.end(), Vec3::Zero());
            M.multiply_add(*motion, internal, options_.threads);
            carried = std::max(carried, factor * norm(internal));
        }
        // inertia of the last digit of positions, which gaps are made of: no tolerance can ask for less
        double largest = 0;
        for (const bool displacements : {true, false}) {
            std::vector<Vec3> x = state_.u;
            for (std::size_t i = 0; i < x.size() && !displacements; ++i) x[i] += model_.X[i];
            std::fill(internal.begin(), internal.end(), Vec3::Zero());
            M.multiply_add(x, internal, options_.threads);
            for (const Vec3& f : internal) largest = std::max(largest, f.cwiseAbs().maxCoeff());
            if (model_.pairs.empty()) break;
        }
        const double digit = std::numeric_limits<double>::epsilon() / options_.tolerance;
        const double by_u = kinematics(stage.dynamics->integrator, dt).by_u_acceleration;
        carried = std::max(carried, digit * by_u * largest);
    }
    // what internal forces of a rigid motion are made of: round-off of stiffness times displacement, summed over neighbours
    constexpr double sum = 10;
    double farthest = 0;
    for (const Vec3& u : state_.u) farthest = std::max(farthest, u.cwiseAbs().maxCoeff());
    const double round_off =
        sum * std::numeric_limits<double>::epsilon() / options_.tolerance * model::largest_stiffness(model_) * farthest;
    if (carried > round_off) return carried;
    // driven nodes that move ahead of their bodies; by a small part of it, as elements may not bear the whole
    constexpr double part = 1e-3;
    std::vector<Vec3> u = state_.u;
    for (Index i = 0; i < model_.nodes(); ++i) {
        const Vec3 now = equilibrium.constraints().to_local(i, u[i]);
        Vec3 moved = now;
        for (int k = 0; k < 3; ++k)
            if (equilibrium.constraints().constraint(i, k) != nullptr)
                moved(k) += part * (load.prescribed[i](k) - now(k));
        u[i] = equilibrium.constraints().to_global(i, moved);
    }
    const double driven = norm(model::internal_force(model_, u, options_.threads)) / part;
    return std::max(driven, round_off) > 0 ? std::max(driven, round_off) : 1;
}

std::string Stepper::explain(const LadderResult& result, const Equilibrium& equilibrium, Attempt& attempt) const {
    Index node = equilibrium.worst_node();
    if (result.failing_equation >= 0)
        for (Index i = 0; i < model_.nodes(); ++i)
            for (int k = 0; k < 3; ++k)
                if (equilibrium.constraints().equation(i, k) == result.failing_equation) node = i;
    std::ostringstream text;
    if (const model::WorstElement& worst = equilibrium.worst_element(); !worst.admissible()) {
        const model::Body& body = model_.bodies[static_cast<std::size_t>(worst.body)];
        attempt.body = body.name;
        attempt.value = worst.J;
        text << result.rung << ": element " << worst.element << " of body '" << body.name
             << "' is turned inside out, det F = " << worst.J
             << "; smaller steps, a finer mesh or a material that resists compression (neo_hookean) may help";
        return text.str();
    }
    name_node(node, attempt);
    attempt.value = result.residual;
    text << result.rung << ": " << solve::describe(result.outcome) << " after " << result.iterations
         << " iterations, relative residual " << result.residual;
    if (!attempt.body.empty()) text << ", worst at node " << attempt.node << " of body '" << attempt.body << "'";
    switch (result.outcome) {
    case solve::KinsolOutcome::singular:
        text << "; a body is held by nothing: add a support, or check that it touches another at the start";
        break;
    case solve::KinsolOutcome::stopped:
        text << "; contact statuses go round in a circle: smaller steps, or a finer master, break it";
        break;
    case solve::KinsolOutcome::max_iterations:
        text << "; raise solver.max_iterations, or solver.tolerance where the residual has come to rest at round-off";
        break;
    default: break;
    }
    return text.str();
}

void Stepper::name_node(Index node, Attempt& attempt) const {
    for (const model::Body& body : model_.bodies)
        if (node >= body.first_node && node < body.first_node + body.nodes()) {
            attempt.body = body.name;
            attempt.node = node - body.first_node;
        }
}

double Stepper::local_error(const Dynamics& dynamics, const Constraints& constraints, const std::vector<Vec3>& a,
                            double dt) const {
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
        largest = std::max(largest, dynamics.integrator.local_error(change, Vec3::Zero(), dt));
    }
    return largest;
}

void Stepper::refresh_patches() {
    if (model_.pairs.empty()) return;
    std::vector<Vec3> x = model_.X;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += state_.u[i];
    for (auto& pair : model_.pairs) refreshed_patches_ += pair->refresh(x);
}

void Stepper::run_stage(const Stage& stage, StepObserver& observer) {
    const Constraints constraints(model_.nodes(), stage.constraints);
    const Dynamics* dynamics = stage.dynamics ? &*stage.dynamics : nullptr;
    Equilibrium equilibrium(model_, constraints, dynamics, timings_, options_.threads,
                            !stage.follower_pressures.empty());
    solve::KinsolSolver solver(equilibrium.size(), timings_);
    std::vector<Vec3> prescribed_start(model_.X.size());
    for (Index node = 0; node < model_.nodes(); ++node)
        prescribed_start[node] = constraints.to_local(node, state_.u[node]);

    if (dynamics != nullptr && state_.v.empty()) {
        // a later one, after statics, starts at rest
        state_.v = moved_ ? std::vector<Vec3>(model_.X.size(), Vec3::Zero()) : model_.initial_velocity;
        moved_ = true;
        for (Index node = 0; node < model_.nodes(); ++node) { // what holds a body does not move with it
            Vec3 v = constraints.to_local(node, state_.v[node]);
            for (int k = 0; k < 3; ++k)
                if (const auto* c = constraints.constraint(node, k); c != nullptr && !c->driven) v(k) = 0;
            state_.v[node] = constraints.to_global(node, v);
        }
        StepLoad load = load_at(stage, constraints, prescribed_start, 0);
        add_follower_forces(load.pressures, model_, state_.u, load.force);
        find_initial_acceleration(stage, constraints, load.force);
        ledger_ = opened(model_, *dynamics, state_);
    }

    const double t_start = state_.time, step = stage.duration / stage.steps;
    const bool controlled = std::isfinite(stage.limits.allowed_interpenetration) && !model_.pairs.empty();
    double dt = step; // not end - begin: round-off would make every step another one
    int repeats = 0;
    CollisionCheck collisions(model_, stage.limits, stage.follow_paths, timings_, options_.threads);
    std::vector<double> corners;
    for (const Course& course : stage.courses)
        corners.insert(corners.end(), course.corners.begin(), course.corners.end());
    corners = corners_between(std::move(corners), t_start, stage.duration, stage.steps);
    auto corner = corners.begin();
    for (int k = 0; k < stage.steps;) {
        const double step_end = t_start + (k + 1) * step;
        const bool to_corner = corner != corners.end() && *corner < step_end;
        const double end = to_corner ? *corner : step_end; // a time that is hit exactly
        constexpr double sliver = 1e-9;                    // of the step: round-off of the times, not a step of its own
        const double left = end - state_.time;
        const bool to_end = dt >= left * (1 - sliver);
        const double time = to_end ? end : state_.time + dt, proposed = dt;
        if (to_end && dt > left * (1 + sliver)) dt = left;

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
                             {},
                             {}};
        if (model_.finite_strain) {
            ladder.predicted = u;
            ladder.unpredicted = state_.u;
        }
        Statuses statuses;
        equilibrium.set_reference_force(ladder.reference_force);
        bool forced = false;
        if (dynamics == nullptr) // inertia holds what nothing touches
            forced = starting_statuses(equilibrium, z, statuses);
        else
            for (const model::ContactHistory& history : state_.contact) statuses.push_back(history.status);
        const std::vector<Vec3> force = dynamics != nullptr ? load.force : std::vector<Vec3>{};
        equilibrium.begin_attempt(state_, std::move(load), dt);
        const long factorised = solver.factorisations();

        // trial with the statuses known at the start; its solution is where the equilibrium with contact starts from
        StepEvidence evidence;
        Decision decision;
        LadderResult result;
        int iterations = 0;
        if (controlled && !forced) {
            Vector trial = z;
            result = solve_trial(equilibrium, solver, trial, statuses, ladder);
            iterations = result.iterations;
            if (result.converged()) {
                collisions.add_trial(equilibrium.state(trial).u, evidence);
                evidence.iterations = iterations;
                decision = judge(evidence, stage.limits, dt, repeats);
                z = std::move(trial);
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
            evidence.iterations = iterations;
            evidence.residual = result.residual;
            evidence.forced = options_.reject_every > 0 && (attempts_ + 1) % options_.reject_every == 0;
            if (result.converged()) {
                next = equilibrium.state(z);
                next.time = time;
                if (controlled) collisions.add_solution(next.u, evidence);
                if (dynamics != nullptr) {
                    ledger = advanced(ledger_, model_, *dynamics, equilibrium, state_, next, force);
                    if (std::isfinite(stage.limits.error_tolerance))
                        evidence.local_error = local_error(*dynamics, constraints, next.a, dt);
                    evidence.energy_jump = energy_from_nowhere(ledger_, ledger);
                }
            }
            decision = judge(evidence, stage.limits, dt, repeats);
        }
        factorisations_ += solver.factorisations() - factorised;
        paths_followed_ += collisions.take_paths_followed();

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
        if (decision.reason == Reason::solver) attempt.cause = explain(result, equilibrium, attempt);
        if (decision.pair >= 0) name_node(model_.pairs[decision.pair]->slaves().node[decision.slave], attempt);
        if (decision.verdict == Verdict::accept) {
            equilibrium.commit();
            state_ = std::move(next);
            if (dynamics != nullptr) ledger_ = ledger;
            observer.attempted(attempt, equilibrium.records());
            observer.accepted({state_, equilibrium, dt, iterations, stage, dynamics != nullptr ? &ledger_ : nullptr});
            refresh_patches();
            repeats = 0;
            if (to_end && to_corner) ++corner;
            if (to_end && !to_corner) ++k;
            dt = std::max(decision.dt, proposed); // a step that was short of a target alone keeps its size for the next
            continue;
        }
        equilibrium.rollback();
        observer.attempted(attempt, equilibrium.records());
        if (decision.verdict == Verdict::give_up)
            throw RunFailure("stage '" + stage.name + "', step of " + number(dt) + " s to time " + number(time) +
                             " s, the smallest allowed, failed. " + attempt.cause);
        if (decision.reason != Reason::forced) ++repeats;
        dt = decision.reason == Reason::forced ? proposed : decision.dt;
    }
}

} // namespace osculate::time
