/// What Stepper::run_stage starts a step from: loads, first iterate, first statuses, accelerations, scale of the forces.

#include "osculate/core/error.hpp"
#include "osculate/time/post_mortem.hpp"
#include "osculate/time/stepper.hpp"
#include "time/number.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>

namespace osculate::time {

using contact::Status;
using model::Constraints;

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
            throw LoadNotFinite("stage '" + stage.name + "': " + course.name + " is " + number(value.back()) + " at " +
                                    number(elapsed) + " s after the stage's start",
                                course.name, elapsed);
    }
    for (const CourseForce& part : stage.course_forces)
        for (std::size_t i = 0; i < load.force.size(); ++i) load.force[i] += value[part.course] * part.pattern[i];
    for (const FollowerPressure& pressure : stage.follower_pressures) {
        const double now =
            pressure.course >= 0 ? value[pressure.course] : pressure.start + ramp * (pressure.end - pressure.start);
        load.pressures.push_back({&pressure.faces, now, now});
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
        const model::ContactEvaluation& evaluation = equilibrium.contact()[p];
        const model::ContactPair& pair = evaluation.pair();
        if (std::any_of(statuses[p].begin(), statuses[p].end(), contact::is_closed)) continue;
        // "closed where g < 0" would start a smooth master, which leaves a small gap everywhere, without any support
        double least = std::numeric_limits<double>::max();
        for (Index j = 0; j < pair.size(); ++j)
            if (evaluation.point(j).found) least = std::min(least, evaluation.point(j).gap);
        for (Index j = 0; j < pair.size(); ++j) {
            if (!evaluation.point(j).found) continue;
            const double tolerance =
                pair.options().closing_tolerance * pair.surface().facet_size(evaluation.point(j).facet);
            if (least > tolerance || evaluation.point(j).gap > std::max(least, 0.0) + tolerance) continue;
            statuses[p][j] = pair.options().friction > 0 ? Status::stick : Status::glide;
            forced = true;
        }
    }
    return forced;
}

StabilisationOptions Stepper::stabilisation_options(const model::ContactEvaluations& contact) const {
    StabilisationOptions how;
    how.share = [this]() -> const std::vector<double>& {
        if (volume_shares_.empty()) volume_shares_ = model::volume_shares(model_);
        return volume_shares_;
    };
    how.farthest = characteristic_length_;
    constexpr double part = 0.05; // of the model, where there is no facet to compare with
    how.finest = part * characteristic_length_;
    how.gap = 2 * how.finest; // of no account without pairs
    if (model_.pairs.empty()) return how;
    how.gap = how.farthest;
    for (const model::ContactEvaluation& evaluation : contact) {
        how.finest = std::min(how.finest, evaluation.pair().finest());
        how.gap = std::min(how.gap, evaluation.least_gap());
    }
    return how;
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
        model::ContactEvaluation evaluation(*model_.pairs[p]);
        evaluation.begin_step(x, state_.contact[p], timings_, options_.threads);
        evaluation.evaluate(x, timings_, options_.threads);
        for (Index j = 0; j < evaluation.pair().size(); ++j)
            evaluation.for_each_force(j, state_.contact[p].lambda[j],
                                      [&](Index node, const Vec3& own_force) { f[node] += own_force; });
    }
    model::PenaltyStiffness free_mass(constraints, M);
    free_mass.set_springs({});
    const auto solver = solve::make_cholesky();
    // nodes without mass have no acceleration of their own
    solve::SparseMatrix matrix = free_mass.matrix();
    const double heaviest = matrix.value.empty() ? 0 : *std::ranges::max_element(matrix.value);
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
    double external = 0;
    if (load.pressures.empty()) {
        external = norm(load.force);
    } else {
        std::vector<Vec3> force = load.force;
        std::vector<FollowerLoad> pressures = load.pressures;
        for (FollowerLoad& pressure : pressures) pressure.start = pressure.end;
        add_follower_forces(pressures, model_, state_.u, force);
        external = norm(force);
    }
    double carried = std::max(external, norm(internal));
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
    double farthest = largest_displacement();
    for (const Vec3& u : load.prescribed) farthest = std::max(farthest, u.cwiseAbs().maxCoeff());
    const double round_off = round_off_force() * farthest;
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
    return std::max(driven, round_off);
}

double Stepper::largest_displacement() const {
    double farthest = 0;
    for (const Vec3& u : state_.u) farthest = std::max(farthest, u.cwiseAbs().maxCoeff());
    return farthest;
}

double Stepper::round_off_force() const {
    // the last digits of displacements, over neighbours; sums of the forces themselves lose no more, see multiply_add_relative()
    return std::numeric_limits<double>::epsilon() / options_.tolerance * largest_stiffness_;
}

double Stepper::imbalance(Equilibrium& equilibrium, const Vector& z, const Statuses& statuses, bool forced) {
    Vector F(z.size());
    equilibrium.set_statuses(statuses, StatusRule::natural, forced);
    if (equilibrium.residual(z.data(), F.data()) == solve::NonlinearProblem::Verdict::shorten) return 1;
    return F.norm() > 0 ? F.norm() : 1; // where nothing is out of balance any unit will do
}

} // namespace osculate::time
