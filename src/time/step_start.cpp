#include "time/step_start.hpp"

#include "osculate/core/dense_algebra.hpp"
#include "osculate/core/error.hpp"
#include "osculate/core/rounded_sum.hpp"
#include "osculate/equilibrium/coupling_start.hpp"
#include "osculate/time/post_mortem.hpp"
#include "time/number.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <utility>

namespace osculate::time {

using contact::Status;
using linear::Constraints;

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

equilibrium::StepLoad load_at(const model::Model& model, const Stage& stage, const linear::Constraints& constraints,
                              const Field& prescribed_start, double elapsed) {
    const double ramp = stage.ramp ? elapsed / stage.duration : 1;
    equilibrium::StepLoad load;
    load.force = stage.force(model.X.size(), ramp);
    std::vector<double> value;
    for (const Course& course : stage.courses) {
        value.push_back(course.at(elapsed));
        if (!std::isfinite(value.back()))
            throw LoadNotFinite("stage '" + stage.name + "': " + course.name + " is " + number(value.back()) + " at " +
                                    number(elapsed) + " s after the stage's start",
                                course.name, elapsed);
    }
    for (const CourseForce& part : stage.course_forces) part.pattern.add_to(value[part.course], load.force);
    for (const FollowerPressure& pressure : stage.follower_pressures) {
        const double now =
            pressure.course >= 0 ? value[pressure.course] : pressure.start + ramp * (pressure.end - pressure.start);
        load.pressures.push_back({&pressure.faces, now, now});
    }
    if (!stage.temperatures.empty()) load.temperature.assign(model.X.size(), 0);
    for (const NodeTemperature& part : stage.temperatures) {
        const double now = part.course >= 0 ? value[part.course] : part.start + ramp * (part.end - part.start);
        for (const Index node : part.nodes) load.temperature[static_cast<std::size_t>(node)] = now;
    }
    load.prescribed = prescribed_start;
    for (Index node = 0; node < model.nodes(); ++node)
        for (int k = 0; k < 3; ++k)
            if (const auto* c = constraints.constraint(node, k); c != nullptr && c->driven) {
                const double start = prescribed_start[node](k);
                load.prescribed[node](k) =
                    c->course >= 0 ? c->target * value[c->course] : start + ramp * (c->target - start);
            }
    return load;
}

void predict(const model::Model& model, const linear::Constraints& constraints, const Field& prescribed, Field& u) {
    for (const model::Body& body : model.bodies) {
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
        Matrix M(static_cast<Index>(rows.size()), 6);
        for (std::size_t i = 0; i < rows.size(); ++i) M.row(static_cast<Index>(i)) = rows[i];
        const Vector delta = Eigen::Map<const Vector>(increments.data(), static_cast<Index>(increments.size()));
        const Vector motion = least_squares(M, delta); // the smallest that fits
        constexpr double fit = 1e-8;
        if ((M * motion - delta).cwiseAbs().maxCoeff() > fit * largest) continue;
        const Vec3 t = motion.head<3>(), w = motion.tail<3>() / size;
        for (Index i = 0; i < body.nodes(); ++i) {
            Vec3& ui = u[body.first_node + i];
            ui += t + w.cross(Vec3(body.mesh.nodes[i] + ui - centre));
        }
    }
    model::move_tied(model, u);
}

namespace {
/// Contact of pair p at displacements u, in a step from a state.
model::ContactEvaluation evaluated(RunContext& context, std::size_t p, const model::State& state, const Field& u) {
    const std::size_t n = u.size();
    Field x(n), tails(n);
    const auto place = [&](const Field& at) {
        for (std::size_t i = 0; i < n; ++i) tails[i] = rounded_off(context.model.X[i], at[i], x[i]);
    };
    model::ContactEvaluation evaluation(*state.contact[p].pair);
    place(state.u);
    evaluation.begin_step(x, state.contact[p], context.timings, context.options.threads, tails);
    place(u);
    evaluation.evaluate(x, context.timings, context.options.threads, tails);
    return evaluation;
}
} // namespace

namespace {
/// Contact of all pairs at displacements u, each evaluated when it is first asked for.
class ContactAhead {
public:
    ContactAhead(RunContext& context, const model::State& state, const Field& u)
        : context_(context), state_(state), u_(u), pairs_(state.contact.size()) {}
    const model::ContactEvaluation& operator[](std::size_t p) {
        if (!pairs_[p]) pairs_[p].emplace(evaluated(context_, p, state_, u_));
        return *pairs_[p];
    }
    /// Whether some nodes of the pair touch, and whether all of these have gone past what they touched.
    [[nodiscard]] bool touches(std::size_t p) const {
        return std::ranges::any_of(state_.contact[p].status, contact::is_closed);
    }
    [[nodiscard]] bool lost(std::size_t p) {
        const std::vector<Status>& status = state_.contact[p].status;
        for (std::size_t j = 0; j < status.size(); ++j)
            if (contact::is_closed(status[j]) && (*this)[p].point(static_cast<Index>(j)).found) return false;
        return touches(p);
    }

private:
    RunContext& context_;
    const model::State& state_;
    const Field& u_;
    std::vector<std::optional<model::ContactEvaluation>> pairs_;
};

/// Closes the nodes of a pair whose gaps are within the closing tolerance of the least; none if that is larger than `near`
/// facet sizes, or than the tolerance if this is larger.
bool close_nearest(const model::ContactEvaluation& evaluation, double least, double near,
                   std::vector<Status>& statuses) {
    const model::ContactPair& pair = evaluation.pair();
    bool any = false;
    for (Index j = 0; j < pair.size(); ++j) {
        const contact::ContactPoint& point = evaluation.point(j);
        if (!point.found) continue;
        const double size = pair.surface().facet_size(point.facet), tolerance = pair.options().closing_tolerance * size;
        if (least > std::max(tolerance, near * size) || point.gap > std::max(least, 0.0) + tolerance) continue;
        statuses[static_cast<std::size_t>(j)] = pair.options().friction > 0 ? Status::stick : Status::glide;
        any = true;
    }
    return any;
}

/// Bodies of a pair, in an order that does not tell slave from master.
std::pair<Index, Index> bodies_of(const model::Model& model, const model::ContactPair& pair) {
    const auto first_node = [&](Index node) {
        const model::Body* const body = model::body_of(model, node);
        return body != nullptr ? body->first_node : node; // an exact surface has none
    };
    return std::minmax({first_node(pair.slaves().node.front()), first_node(pair.master_nodes().front())});
}

/// Where all that two bodies touch at goes past an edge or a corner in the step, what is nearest takes over: else they would
/// spring through one another.
bool hand_over(const model::Model& model, const model::State& state, ContactAhead& ahead,
               equilibrium::Statuses& statuses) {
    constexpr double near = 0.1; // facet sizes
    bool forced = false;
    for (std::size_t p = 0; p < statuses.size(); ++p) {
        if (!ahead.lost(p)) continue;
        const auto bodies = bodies_of(model, *state.contact[p].pair);
        std::vector<std::size_t> alike;
        for (std::size_t q = 0; q < statuses.size(); ++q)
            if (bodies_of(model, *state.contact[q].pair) == bodies) alike.push_back(q);
        if (std::ranges::any_of(alike, [&](std::size_t q) { return ahead.touches(q) && !ahead.lost(q); })) continue;
        double least = std::numeric_limits<double>::infinity();
        for (const std::size_t q : alike) least = std::min(least, ahead[q].least_gap());
        for (const std::size_t q : alike) forced = close_nearest(ahead[q], least, near, statuses[q]) || forced;
    }
    return forced;
}
} // namespace

bool starting_statuses(RunContext& context, const equilibrium::BodyForces& bodies, const model::State& state,
                       const Field& u, bool again, equilibrium::Statuses& statuses) {
    statuses.clear();
    bool any = again;
    for (const auto& history : state.contact) {
        statuses.push_back(history.status);
        any = any || std::none_of(history.status.begin(), history.status.end(), contact::is_closed);
    }
    if (!any) return false;
    Field unused;
    if (!bodies.evaluate(u, unused).admissible()) return false;

    ContactAhead ahead(context, state, u);
    // "closed where g < 0" would start a smooth master, which leaves a small gap everywhere, without any support
    bool forced = false;
    for (std::size_t p = 0; p < statuses.size(); ++p)
        if (!ahead.touches(p)) forced = close_nearest(ahead[p], ahead[p].least_gap(), 0, statuses[p]) || forced;
    return (again && hand_over(context.model, state, ahead, statuses)) || forced;
}

StabilisationOptions stabilisation_options(RunContext& context, const model::State& state, const Field& u) {
    StabilisationOptions how;
    how.share = [&context]() -> const std::vector<double>& { return context.volume_shares(); };
    how.farthest = context.characteristic_length;
    constexpr double part = 0.05; // of the model, where there is no facet to compare with
    how.finest = part * context.characteristic_length;
    for (const model::ContactHistory& history : state.contact)
        how.finest = std::min(how.finest, history.pair->finest());
    how.start = std::make_shared<const Field>(u); // options are copied, and need not copy this
    how.gap = [&context, &state, how] {
        if (state.contact.empty()) return 2 * how.finest; // of no account
        double least = how.farthest;
        for (std::size_t p = 0; p < state.contact.size(); ++p)
            least = std::min(least, evaluated(context, p, state, *how.start).least_gap());
        return least;
    };
    return how;
}

void start_motion(RunContext& context, const Stage& stage, const linear::Constraints& constraints,
                  equilibrium::StepLoad load, MassSolution mass, Progress& progress) {
    const model::Model& model = context.model;
    model::State& state = progress.state;
    // a later one, after statics, starts at rest
    const bool moved = progress.moved;
    state.v = moved ? Field(model.X.size()) : model.initial_velocity;
    progress.moved = true;
    for (Index node = 0; node < model.nodes(); ++node) { // what holds a body does not move with it
        Vec3 v = constraints.to_local(node, state.v[node]);
        for (int k = 0; k < 3; ++k)
            if (const auto* c = constraints.constraint(node, k); c != nullptr && !c->driven) v(k) = 0;
        state.v[node] = constraints.to_global(node, v);
    }
    model::move_tied(model, state.v);
    equilibrium::start_couplings(model, constraints, state);
    equilibrium::add_follower_forces(load.pressures, model, state.u, load.force);
    state.a = initial_acceleration(context, stage, constraints, state, load.force, mass);
    equilibrium::take_accelerations(model, state);
    if (!model.rigid.empty()) {
        if (!moved)
            for (std::size_t k = 0; k < model.rigid.size(); ++k) {
                state.rigid[k].velocity = model.rigid[k].velocity;
                state.rigid[k].angular_velocity = state.rigid[k].orientation.inverse() * model.rigid[k].spin;
            }
        equilibrium::start_rigid_motion(model, constraints, load.force, state);
    }
    progress.ledger = opened(model, *stage.dynamics, state);
}

double reference_force(const RunContext& context, const Stage& stage, const linear::Constraints& constraints,
                       const model::State& state, const equilibrium::StepLoad& load, double dt) {
    const model::Model& model = context.model;
    const StepperOptions& options = context.options;
    model::MaterialHistory material = state.material;
    if (!load.temperature.empty() && model.nonlinear) model.nonlinear->heat(load.temperature, material);
    Field internal = model::internal_force(model, {state.u, state.u, material}, options.threads);
    double external = 0;
    if (load.pressures.empty()) {
        external = norm(load.force);
    } else {
        Field force = load.force;
        std::vector<equilibrium::FollowerLoad> pressures = load.pressures;
        for (equilibrium::FollowerLoad& pressure : pressures) pressure.start = pressure.end;
        equilibrium::add_follower_forces(pressures, model, state.u, force);
        external = norm(force);
    }
    double carried = std::max(external, norm(internal));
    if (stage.dynamics) {
        // a thousandth of the force that would stop every motion within the step
        constexpr double share = 1e-3;
        const linear::BlockMatrix& M = model.mass(stage.dynamics->lumped_mass);
        for (const auto& [motion, factor] : {std::pair{&state.a, 1.0}, std::pair{&state.v, share / dt}}) {
            std::fill(internal.begin(), internal.end(), Vec3::Zero());
            M.multiply_add(*motion, internal, options.threads);
            carried = std::max(carried, factor * norm(internal));
        }
        // inertia of the last digit of positions, which gaps are made of: no tolerance can ask for less
        double largest = 0;
        for (const bool displacements : {true, false}) {
            std::fill(internal.begin(), internal.end(), Vec3::Zero());
            M.multiply_add(displacements ? state.u : sum(state.u, model.X), internal, options.threads);
            largest = std::max(largest, largest_component(internal));
            if (state.contact.empty()) break;
        }
        for (std::size_t k = 0; k < model.rigid.size(); ++k) {
            const model::RigidBody& body = model.rigid[k];
            const model::RigidMotion& motion = state.rigid[k];
            const double rate = std::max(body.mass * motion.acceleration.norm(), motion.moment.norm() / body.radius),
                         momentum = std::max(body.mass * motion.velocity.norm(),
                                             model::angular_momentum(body, motion).norm() / body.radius);
            const auto r = static_cast<std::size_t>(body.reference);
            carried = std::max({carried, rate, share / dt * momentum});
            largest =
                std::max({largest, body.mass * (model.X[r] + state.u[r]).cwiseAbs().maxCoeff(),
                          body.inertia.norm() / (body.radius * body.radius) * state.u[r + 1].cwiseAbs().maxCoeff()});
        }
        const double digit = std::numeric_limits<double>::epsilon() / options.tolerance;
        const double by_u = kinematics(stage.dynamics->integrator, dt).by_u_acceleration;
        carried = std::max(carried, digit * by_u * largest);
    }
    const double farthest = std::max(largest_component(state.u), largest_component(load.prescribed));
    const double round_off = context.round_off_force() * farthest;
    if (carried > round_off) return carried;
    // driven nodes that move ahead of their bodies; by a small part of it, as elements may not bear the whole
    constexpr double part = 1e-3;
    Field u = state.u;
    for (Index i = 0; i < model.nodes(); ++i) {
        const Vec3 now = constraints.to_local(i, u[i]);
        Vec3 moved = now;
        for (int k = 0; k < 3; ++k)
            if (constraints.constraint(i, k) != nullptr) moved(k) += part * (load.prescribed[i](k) - now(k));
        u[i] = constraints.to_global(i, moved);
    }
    for (std::size_t k = 0; k < model.rigid.size(); ++k) { // coupled nodes go with their reference points
        const model::RigidBody& body = model.rigid[k];
        if (!body.coupling) continue;
        const auto t = static_cast<std::size_t>(body.rotation());
        const Vec3 theta = (u[t] - state.u[t]) / body.radius;
        model::spread_displacements(model, body, model::turned(state.rigid[k].orientation, theta), u);
    }
    model::move_tied(model, u);
    const double driven = norm(model::internal_force(model, {state.u, u, material}, options.threads)) / part;
    return std::max(driven, round_off);
}

double RunContext::round_off_force() const {
    return std::numeric_limits<double>::epsilon() / options.tolerance * largest_stiffness;
}

double imbalance(equilibrium::Equilibrium& equilibrium, const Vector& z, const equilibrium::Statuses& statuses,
                 bool forced) {
    Vector F(z.size());
    equilibrium.set_statuses(statuses, equilibrium::StatusRule::natural, forced);
    if (equilibrium.residual(z, F) == solve::NonlinearProblem::Verdict::shorten) return 1;
    return F.norm() > 0 ? F.norm() : 1; // where nothing is out of balance any unit will do
}

} // namespace osculate::time
