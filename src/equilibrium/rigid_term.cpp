#include "osculate/equilibrium/rigid_term.hpp"

#include "osculate/core/dense_algebra.hpp"
#include "osculate/equilibrium/coupling_start.hpp"

#include <algorithm>
#include <numbers>

namespace osculate::equilibrium {

using model::cross_matrix;
using model::RigidBody;

namespace {
std::size_t place_of(Index node) {
    return static_cast<std::size_t>(node);
}
} // namespace

RigidTerm::RigidTerm(const model::Model& model, const linear::Constraints& constraints, const Dynamics* dynamics)
    : model_(model), dynamics_(dynamics), alpha_f_(dynamics != nullptr ? dynamics->integrator.alpha_f : 0),
      bodies_(model.rigid.size()), dependence_(model.nodes()) {
    constexpr double apart = 1e-9; // of the radius
    for (const RigidBody& body : model.rigid) {
        for (const Index node : body.nodes) dependence_.set(node, {{body.reference}, {body.rotation()}});
        by_reference_.push_back((body.centre - model.X[place_of(body.reference)]).norm() > apart * body.radius &&
                                constraints.free_components(body.reference) < 3);
    }
    add_ties(model, dependence_);
}

bool RigidTerm::begin(const model::State& state, const Iterate& at, const StepLoad&, double dt) {
    dt_ = dt;
    if (dynamics_ != nullptr) {
        kinematics_ = kinematics(dynamics_->integrator, dt);
        alpha_f_ = dynamics_->integrator.alpha_f;
    }
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        const RigidBody& body = model_.rigid[k];
        Moving& moving = bodies_[k];
        moving.start = state.rigid[k];
        moving.u_start = state.u[place_of(body.reference)];
        moving.angles_start = state.u[place_of(body.rotation())];
        moving.turning.setZero();
        moving.R_start = moving.start.orientation.toRotationMatrix();
    }
    (void)renew(at.u);
    return false;
}

void RigidTerm::place(Field& u) const {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        const RigidBody& body = model_.rigid[k];
        const Vec3 theta = (u[place_of(body.rotation())] - bodies_[k].angles_start) / body.radius;
        model::spread_displacements(model_, body, model::turned(bodies_[k].start.orientation, theta), u);
    }
    model::move_tied(model_, u);
}

Vec3 RigidTerm::centre_arm(const RigidBody& body, const Mat3& R) const {
    return R * (body.centre - model_.X[place_of(body.reference)]);
}

bool RigidTerm::move(std::size_t k, const Field& u, Moving& now) const {
    constexpr double most = 0.95 * std::numbers::pi; // rad
    const RigidBody& body = model_.rigid[k];
    const Vec3 theta = (u[place_of(body.rotation())] - now.angles_start) / body.radius;
    if (!(theta.norm() < most)) return false;
    now.theta = theta;
    now.Du = u[place_of(body.reference)] - now.u_start;
    now.c = model::cayley(theta);
    now.T = model::tangent_map(theta);
    now.end = {};
    now.end.orientation = model::turned(now.start.orientation, theta);
    now.end.rotation = model::rotation_vector(now.end.orientation, now.start.rotation);
    now.R = now.end.orientation.toRotationMatrix();
    if (dynamics_ == nullptr) return true;
    if (body.coupling)
        set_mean_velocity(now);
    else if (by_reference_[k] != 0)
        set_inertia_of_reference(body, now);
    else
        set_inertia_of_centre(body, now);
    return true;
}

bool RigidTerm::renew(const Field& u) {
    bool all = true;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        const RigidBody& body = model_.rigid[k];
        Moving& now = bodies_[k];
        if (!move(k, u, now)) {
            all = false;
            continue;
        }
        const Vec3& X_r = model_.X[place_of(body.reference)];
        for (const Index node : body.nodes) {
            const Vec3 arm = model_.X[place_of(node)] - X_r, rho = now.R * arm;
            const Vec3 acting = (1 - alpha_f_) * rho + alpha_f_ * (now.R_start * arm);
            dependence_.set(node, {{body.reference},
                                   {body.rotation(), -cross_matrix(rho) * now.T / body.radius,
                                    cross_matrix(acting) / body.radius}});
        }
    }
    return all;
}

void RigidTerm::set_mean_velocity(Moving& now) const {
    now.end.velocity = now.Du / dt_;
    now.end.angular_velocity = now.R_start.transpose() * now.theta / dt_;
}

void RigidTerm::set_inertia_of_centre(const RigidBody& body, Moving& now) const {
    const Integrator& w = dynamics_->integrator;
    const model::RigidMotion& n = now.start;
    model::RigidMotion& end = now.end;
    const Vec3 zero = Vec3::Zero();
    const Vec3 arm_n = centre_arm(body, now.R_start), arm = centre_arm(body, now.R);
    const Vec3 Dx = now.Du + now.c.cross((arm + arm_n) / 2); // = Du + arm - arm_n, to more digits
    end.velocity = kinematics_.velocity(Dx, zero, n.velocity, n.acceleration);
    end.acceleration = kinematics_.acceleration(Dx, zero, n.velocity, n.acceleration);
    const Vec3 turned = now.R_start.transpose() * now.c;
    end.angular_velocity = kinematics_.velocity(turned, zero, n.angular_velocity, n.angular_rate);
    end.angular_rate = kinematics_.acceleration(turned, zero, n.angular_velocity, n.angular_rate);
    const Vec3 p = now.R * (body.inertia * end.angular_velocity),
               p_n = now.R_start * (body.inertia * n.angular_velocity);
    end.moment = (p - p_n) / (w.gamma * dt_) - (1 - w.gamma) / w.gamma * n.moment;
    const Vec3 acting = (1 - w.alpha_f) * arm + w.alpha_f * arm_n;
    now.force = body.mass * ((1 - w.alpha_m) * end.acceleration + w.alpha_m * n.acceleration);
    now.moment = (1 - w.alpha_m) * end.moment + w.alpha_m * n.moment + acting.cross(now.force);

    // dp = T dtheta x p + R J dW, dW = (dW/dc) R_n^T C dtheta
    const double m = (1 - w.alpha_m) * kinematics_.by_u_acceleration * body.mass;
    const Mat3 C = model::cayley_derivative(now.theta);
    now.force_by_r = m * Mat3::Identity();
    now.force_by_theta = -m * cross_matrix(arm) * now.T;
    const Mat3 p_by_theta =
        -cross_matrix(p) * now.T + kinematics_.by_u_velocity * now.R * body.inertia * now.R_start.transpose() * C;
    now.moment_by_r = m * cross_matrix(acting);
    now.moment_by_theta = (1 - w.alpha_m) / (w.gamma * dt_) * p_by_theta + cross_matrix(acting) * now.force_by_theta +
                          (1 - w.alpha_f) * cross_matrix(now.force) * cross_matrix(arm) * now.T;
}

void RigidTerm::set_inertia_of_reference(const RigidBody& body, Moving& now) const {
    const Integrator& w = dynamics_->integrator;
    const model::RigidMotion& n = now.start;
    model::RigidMotion& end = now.end;
    const Vec3 zero = Vec3::Zero();
    const Vec3 arm_n = centre_arm(body, now.R_start), arm = centre_arm(body, now.R),
               own = body.centre - model_.X[place_of(body.reference)];
    const Mat3 J_r = body.inertia - body.mass * cross_matrix(own) * cross_matrix(own);
    const double m = body.mass;
    // at the start
    const Vec3 w_n = now.R_start * n.angular_velocity, rate_n = now.R_start * n.angular_rate, b_n = w_n.cross(arm_n),
               v_n = n.velocity - b_n, a_n = n.acceleration - rate_n.cross(arm_n) - w_n.cross(b_n),
               q_n = m * n.velocity, l_n = now.R_start * (J_r * n.angular_velocity) + m * arm_n.cross(v_n),
               q_rate_n = m * n.acceleration, l_rate_n = n.moment + b_n.cross(q_n) + arm_n.cross(q_rate_n);
    // at the end
    const Vec3 v = kinematics_.velocity(now.Du, zero, v_n, a_n), turned = now.R_start.transpose() * now.c;
    end.angular_velocity = kinematics_.velocity(turned, zero, n.angular_velocity, n.angular_rate);
    end.angular_rate = kinematics_.acceleration(turned, zero, n.angular_velocity, n.angular_rate);
    const Vec3 spin = now.R * end.angular_velocity, b = spin.cross(arm);
    end.velocity = v + b;
    const Vec3 q = m * end.velocity, J_w = now.R * (J_r * end.angular_velocity), l = J_w + m * arm.cross(v);
    const double old = (1 - w.gamma) / w.gamma, fresh = 1 / (w.gamma * dt_);
    const Vec3 q_rate = fresh * (q - q_n) - old * q_rate_n, l_rate = fresh * (l - l_n) - old * l_rate_n;
    end.acceleration = q_rate / m;
    end.moment = l_rate - b.cross(q) - arm.cross(q_rate);
    const Mat3 Q = now.R * now.R_start.transpose();
    const Vec3 before = v_n + Q * v_n, after = v + Q.transpose() * v;
    now.force = (1 - w.alpha_m) * q_rate + w.alpha_m * q_rate_n;
    now.moment = (1 - w.alpha_m) * l_rate + w.alpha_m * l_rate_n + m / 4 * (before.cross(b) + after.cross(b_n));

    // derivatives by u_r, and by theta with dphi = T dtheta: d rho = dphi x rho, d w = dphi x w + R dW
    const double by_v = kinematics_.by_u_velocity;
    const Mat3 spin_by =
        -cross_matrix(spin) * now.T + by_v * now.R * now.R_start.transpose() * model::cayley_derivative(now.theta);
    const Mat3 arm_by = -cross_matrix(arm) * now.T;
    const Mat3 b_by = -cross_matrix(arm) * spin_by + cross_matrix(spin) * arm_by;
    const Mat3 l_by = -cross_matrix(J_w) * now.T +
                      by_v * now.R * J_r * now.R_start.transpose() * model::cayley_derivative(now.theta) -
                      m * cross_matrix(v) * arm_by;
    const double factor = (1 - w.alpha_m) * fresh;
    now.force_by_r = factor * m * by_v * Mat3::Identity();
    now.force_by_theta = factor * m * b_by;
    now.moment_by_r =
        factor * m * by_v * cross_matrix(arm) - m / 4 * by_v * cross_matrix(b_n) * (Mat3::Identity() + Q.transpose());
    // d(Q v_n) = dphi x Q v_n, d(Q^T v) = -Q^T (dphi x v)
    const Vec3 ahead = Q * v_n;
    now.moment_by_theta =
        factor * l_by + m / 4 *
                            (cross_matrix(before) * b_by + cross_matrix(b) * cross_matrix(ahead) * now.T -
                             cross_matrix(b_n) * Q.transpose() * cross_matrix(v) * now.T);
}

bool RigidTerm::evaluate(const Iterate& at) {
    return renew(at.u);
}

void RigidTerm::add_forces(Field& f) const {
    if (dynamics_ == nullptr) return;
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        if (model_.rigid[k].coupling) continue;
        f[place_of(model_.rigid[k].reference)] += bodies_[k].force;
        f[place_of(model_.rigid[k].rotation())] += bodies_[k].moment / model_.rigid[k].radius;
    }
}

void RigidTerm::add_magnitudes(const Iterate&, Field& sums) const {
    if (dynamics_ == nullptr) return;
    // inertia is a difference of momenta over the time
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        const RigidBody& body = model_.rigid[k];
        if (body.coupling) continue;
        const Moving& now = bodies_[k];
        const Vec3 p = body.mass / dt_ * (now.end.velocity.cwiseAbs() + now.start.velocity.cwiseAbs());
        sums[place_of(body.reference)] += p + body.mass * kinematics_.by_u_acceleration * now.Du.cwiseAbs();
        const double L =
            (model::angular_momentum(body, now.end).norm() + model::angular_momentum(body, now.start).norm() +
             body.inertia.norm() * kinematics_.by_u_velocity * now.c.norm()) /
            dt_;
        const double arm = centre_arm(body, now.R).norm();
        sums[place_of(body.rotation())].array() += (L + arm * p.norm()) / body.radius;
    }
}

void RigidTerm::fold(Field& f) {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        // d[(1-alpha_f) rho x f] = -(1-alpha_f) f x (T dtheta x rho) = (1-alpha_f) [f] [rho] T dtheta
        const RigidBody& body = model_.rigid[k];
        const Vec3& X_r = model_.X[place_of(body.reference)];
        Mat3 sum = Mat3::Zero();
        Vec3 swept = Vec3::Zero();
        for (const Index i : body.nodes) {
            const std::size_t node = place_of(i);
            if (f[node].isZero(0)) continue;
            const Vec3 arm = model_.X[node] - X_r, rho = bodies_[k].R * arm;
            sum += cross_matrix(f[node]) * cross_matrix(rho);
            swept += (rho - bodies_[k].R_start * arm).cross(f[node]);
        }
        bodies_[k].swept = swept;
        bodies_[k].turning = (1 - alpha_f_) * sum * bodies_[k].T;
    }
    if (!model_.led.empty()) led_force_.assign(model_.bodies.size(), Vec3::Zero());
    for (const model::LedNode& one : model_.led) {
        const auto on = [&](Index node) -> Vec3& {
            const RigidBody* rigid = model::rigid_body_of(model_, node);
            return led_force_[static_cast<std::size_t>(rigid != nullptr ? rigid->body
                                                                        : model::body_index(model_, node))];
        };
        const double force = one.direction.dot(f[place_of(one.node)]);
        on(one.node) += force * one.direction;
        for (const auto& [node, by] : one.by) on(node) -= force * by;
    }
    dependence_.fold(f);
}

void RigidTerm::add_tangent(linear::BlockMatrix& tangent) const {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        const RigidBody& body = model_.rigid[k];
        const Moving& now = bodies_[k];
        const Index r = body.reference, t = body.rotation();
        if (!tangent.has_row(r)) continue; // of another process
        const double L = body.radius;
        Mat3 by_theta = now.turning;
        if (dynamics_ != nullptr && !body.coupling) {
            by_theta += now.moment_by_theta;
            tangent.block(tangent.slot(r, r)) += now.force_by_r;
            tangent.block(tangent.slot(r, t)) += now.force_by_theta / L;
            tangent.block(tangent.slot(t, r)) += now.moment_by_r / L;
        }
        tangent.block(tangent.slot(t, t)) += by_theta / (L * L);
    }
}

double RigidTerm::work_of_inertia() const {
    double work = 0;
    for (const Moving& now : bodies_) work += now.force.dot(now.Du) + now.moment.dot(now.c);
    return work;
}

double RigidTerm::work_of_weights() const {
    // f_i . [c x (rho_i + rho_i,n)/2 - c x ((1-alpha_f) rho_i + alpha_f rho_i,n)]
    double work = 0;
    for (const Moving& now : bodies_) work += (alpha_f_ - 0.5) * now.c.dot(now.swept);
    return work;
}

void RigidTerm::make_conjugate(Field& Du) const {
    for (std::size_t k = 0; k < bodies_.size(); ++k)
        Du[place_of(model_.rigid[k].rotation())] = model_.rigid[k].radius * bodies_[k].c;
}

void RigidTerm::complete(const ConstVectorRef&, model::State& state) const {
    for (std::size_t k = 0; k < bodies_.size(); ++k) {
        Moving now = bodies_[k];
        const RigidBody& body = model_.rigid[k];
        (void)move(k, state.u, now);
        state.rigid.push_back(now.end);
        if (dynamics_ != nullptr) model::spread_velocities(model_, body, state.rigid.back(), state);
    }
}

void start_rigid_motion(const model::Model& model, const linear::Constraints& constraints, const Field& force,
                        model::State& state) {
    for (std::size_t k = 0; k < model.rigid.size(); ++k) {
        const RigidBody& body = model.rigid[k];
        if (body.coupling) continue;
        model::RigidMotion& motion = state.rigid[k];
        const Mat3 R = motion.orientation.toRotationMatrix();
        const std::size_t r = place_of(body.reference);
        const Vec3 arm = R * (body.centre - model.X[r]); // of the centre
        const Mat3 J = R * body.inertia * R.transpose();

        // supports stop what they hold
        const auto stop = [&](Index node, Vec3& v) {
            Vec3 local = constraints.to_local(node, v);
            for (int i = 0; i < 3; ++i)
                if (const auto* c = constraints.constraint(node, i); c != nullptr && !c->driven) local(i) = 0;
            v = constraints.to_global(node, local);
        };
        Vec3 w = model::spin(motion), v = motion.velocity - w.cross(arm);
        stop(body.rotation(), w);
        stop(body.reference, v);
        motion.angular_velocity = R.transpose() * w;
        motion.velocity = v + w.cross(arm);

        // m (a_r + rate x arm + w x (w x arm)) = F, J rate + w x J w + arm x (m a_c) = M, held components without
        // acceleration
        Vec3 F = force[r], M = body.radius * force[r + 1];
        for (const Index i : body.nodes) {
            F += force[place_of(i)];
            M += (R * (model.X[place_of(i)] - model.X[r])).cross(force[place_of(i)]);
        }
        const Vec3 centripetal = w.cross(w.cross(arm));
        Mat6 A;
        A << body.mass * Mat3::Identity(), -body.mass * cross_matrix(arm), body.mass * cross_matrix(arm),
            J - body.mass * cross_matrix(arm) * cross_matrix(arm);
        Vec6 b;
        b << F - body.mass * centripetal, M - w.cross(J * w) - body.mass * arm.cross(centripetal);
        std::vector<Index> free;
        Mat6 Q = Mat6::Identity();
        for (int part = 0; part < 2; ++part) {
            const Index node = part == 0 ? body.reference : body.rotation();
            Q.block<3, 3>(3 * part, 3 * part) = constraints.frame(node);
            for (int i = 0; i < 3; ++i)
                if (constraints.constraint(node, i) == nullptr) free.push_back(3 * part + i);
        }
        const auto n = static_cast<Index>(free.size());
        Matrix columns(6, n);
        for (Index i = 0; i < n; ++i) columns.col(i) = Q.col(free[static_cast<std::size_t>(i)]);
        Vec6 a = Vec6::Zero();
        if (n > 0) {
            const Matrix reduced = columns.transpose() * A * columns;
            const Vector right = columns.transpose() * b;
            a = columns * least_squares(reduced, right);
        }
        const Vec3 rate = a.tail<3>();
        motion.acceleration = a.head<3>() + rate.cross(arm) + centripetal;
        motion.moment = J * rate + w.cross(J * w);
        // in body axes the rate of W alone: w x w = 0
        motion.angular_rate = R.transpose() * rate;
        model::spread_velocities(model, body, motion, state);
    }
}

} // namespace osculate::equilibrium
