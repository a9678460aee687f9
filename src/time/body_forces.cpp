#include "osculate/time/body_forces.hpp"

namespace osculate::time {

namespace {
double dot(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
    return sum;
}
std::vector<Vec3> weighted(double a, const std::vector<Vec3>& x, double b, const std::vector<Vec3>& y) {
    std::vector<Vec3> result(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) result[i] = a * x[i] + b * y[i];
    return result;
}
} // namespace

BodyForces::BodyForces(const model::Model& model, const Dynamics* dynamics, int threads)
    : model_(model), dynamics_(dynamics), threads_(threads) {
    if (dynamics_ != nullptr || nonlinear()) tangent_ = model_.K;
    if (nonlinear()) constant_ = model_.K;
}

bool BodyForces::begin(const model::State& state, double dt) {
    if (dynamics_ == nullptr) return false;
    const Integrator& w = dynamics_->integrator;
    u_start_ = state.u;
    v_start_ = state.v;
    a_start_ = state.a;
    if (damps_strain()) set_tangent_of_damping(state.u);
    const bool changed = dt != dt_ || damps_strain();
    if (changed) {
        dt_ = dt;
        kinematics_ = kinematics(w, dt);
        const double inertia = (1 - w.alpha_m) * kinematics_.by_u_acceleration, rest = 1 - w.alpha_f,
                     rate = rest * kinematics_.by_u_velocity;
        model::BlockMatrix& fixed = nonlinear() ? constant_ : tangent_;
        fixed.set_combination(rest + rate * dynamics_->stiffness_damping, model_.K,
                              inertia + rate * dynamics_->mass_damping, mass());
        if (damps_strain())
            fixed.set_combination(1, model::BlockMatrix(fixed), rate * dynamics_->stiffness_damping, damping_);
    }

    const std::size_t n = u_start_.size();
    Field by_M(n), mean_v(n);
    for (std::size_t i = 0; i < n; ++i) {
        const Vec3 v = kinematics_.velocity(u_start_[i], u_start_[i], v_start_[i], a_start_[i]);
        const Vec3 a = kinematics_.acceleration(u_start_[i], u_start_[i], v_start_[i], a_start_[i]);
        mean_v[i] = (1 - w.alpha_f) * v + w.alpha_f * v_start_[i];
        by_M[i] = (1 - w.alpha_m) * a + w.alpha_m * a_start_[i];
    }
    force_start_.assign(n, Vec3::Zero());
    mass().multiply_add(by_M, force_start_, threads_);
    model_.K.multiply_add(u_start_, force_start_, threads_);
    add_damping(mean_v, force_start_);
    if (nonlinear()) {
        internal_start_.assign(n, Vec3::Zero());
        (void)model_.finite_strain->add_internal_force(model_.X, u_start_, internal_start_, threads_);
        for (std::size_t i = 0; i < n; ++i) force_start_[i] += w.alpha_f * internal_start_[i];
    }
    return changed;
}

void BodyForces::set_tangent_of_damping(const Field& u) {
    damping_.set_combination(0, model_.K, 0, {});
    model_.finite_strain->add_tangent(model_.X, u, 1, damping_, threads_);
}

model::WorstElement BodyForces::evaluate(const Field& u, Field& f) const {
    const double share = dynamics_ != nullptr ? 1 - dynamics_->integrator.alpha_f : 1;
    model::WorstElement worst;
    if (nonlinear()) {
        f.assign(u.size(), Vec3::Zero());
        worst = model_.finite_strain->add_internal_force(model_.X, u, f, threads_);
        if (dynamics_ == nullptr) {
            model_.K.multiply_add(u, f, threads_);
            return worst;
        }
        for (std::size_t i = 0; i < f.size(); ++i) f[i] = share * f[i] + force_start_[i];
    } else if (dynamics_ == nullptr) {
        f.assign(u.size(), Vec3::Zero());
        model_.K.multiply_add(u, f, threads_);
        return worst;
    } else {
        f = force_start_;
    }
    // the rest is linear in the motion since the start
    (nonlinear() ? constant_ : tangent_).multiply_add(weighted(1, u, -1, u_start_), f, threads_);
    return worst;
}

bool BodyForces::linearise(const Field& u) {
    if (!nonlinear()) return false;
    tangent_ = constant_;
    model_.finite_strain->add_tangent(model_.X, u, dynamics_ != nullptr ? 1 - dynamics_->integrator.alpha_f : 1,
                                      tangent_, threads_);
    return true;
}

void BodyForces::complete(model::State& state) const {
    if (dynamics_ == nullptr) return;
    for (std::size_t i = 0; i < state.u.size(); ++i) {
        state.v.push_back(kinematics_.velocity(state.u[i], u_start_[i], v_start_[i], a_start_[i]));
        state.a.push_back(kinematics_.acceleration(state.u[i], u_start_[i], v_start_[i], a_start_[i]));
    }
}

double BodyForces::inertia(Index node) const {
    if (dynamics_ == nullptr) return 0;
    double sum = 0;
    for (Index k = mass().row_begin(node); k < mass().row_end(node); ++k) sum += mass().block(k)(0, 0);
    return (1 - dynamics_->integrator.alpha_m) * kinematics_.by_u_acceleration * sum;
}

void BodyForces::add_damping(const Field& v, Field& f) const {
    const double by_M = dynamics_->mass_damping, by_K = dynamics_->stiffness_damping;
    if (by_M > 0) mass().multiply_add(weighted(by_M, v, 0, v), f, threads_);
    if (by_K == 0) return;
    const Field scaled = weighted(by_K, v, 0, v);
    model_.K.multiply_add(scaled, f, threads_);
    if (nonlinear()) damping_.multiply_add(scaled, f, threads_);
}

BodyWork BodyForces::work(const model::State& state) const {
    const Integrator& w = dynamics_->integrator;
    const Field Du = weighted(1, state.u, -1, u_start_);
    BodyWork work;
    Field f(Du.size(), Vec3::Zero());
    mass().multiply_add(weighted(1 - w.alpha_m, state.a, w.alpha_m, a_start_), f, threads_);
    work.inertia = dot(Du, f);
    f.assign(f.size(), Vec3::Zero());
    model_.K.multiply_add(weighted(1 - w.alpha_f, state.u, w.alpha_f, u_start_), f, threads_);
    if (nonlinear()) {
        Field end(f.size(), Vec3::Zero());
        (void)model_.finite_strain->add_internal_force(model_.X, state.u, end, threads_);
        for (std::size_t i = 0; i < f.size(); ++i) f[i] += (1 - w.alpha_f) * end[i] + w.alpha_f * internal_start_[i];
    }
    work.internal = dot(Du, f);
    f.assign(f.size(), Vec3::Zero());
    add_damping(weighted(1 - w.alpha_f, state.v, w.alpha_f, v_start_), f);
    work.damping = dot(Du, f);
    return work;
}

std::vector<Vec3> BodyForces::of(const model::State& state) {
    Field f = model::internal_force(model_, state.u, threads_);
    if (damps_strain()) set_tangent_of_damping(state.u);
    add_damping(state.v, f);
    return f;
}

} // namespace osculate::time
