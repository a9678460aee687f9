#include "osculate/time/body_forces.hpp"

namespace osculate::time {

namespace {
using Field = std::vector<Vec3>;

double dot(const Field& a, const Field& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
    return sum;
}

Field weighted(double a, const Field& x, double b, const Field& y) {
    Field result(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) result[i] = a * x[i] + b * y[i];
    return result;
}

/// f += C v
void add_damping(const model::Model& model, const Dynamics& dynamics, const Field& v, Field& f, int threads) {
    const double by_M = dynamics.mass_damping, by_K = dynamics.stiffness_damping;
    if (by_M > 0) model.mass(dynamics.lumped_mass).multiply_add(weighted(by_M, v, 0, v), f, threads);
    if (by_K > 0) model.K.multiply_add(weighted(by_K, v, 0, v), f, threads);
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
    const bool changed = dt != dt_;
    if (changed) {
        dt_ = dt;
        kinematics_ = kinematics(w, dt);
        mean_ = {1 - w.alpha_f, dynamics_->stiffness_damping / dt};
        const double inertia = (1 - w.alpha_m) * kinematics_.by_u_acceleration, rest = 1 - w.alpha_f,
                     rate = rest * kinematics_.by_u_velocity;
        (nonlinear() ? constant_ : tangent_)
            .set_combination(rest + rate * dynamics_->stiffness_damping, model_.K,
                             inertia + rate * dynamics_->mass_damping, mass());
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
    add_damping(model_, *dynamics_, mean_v, force_start_, threads_);
    return changed;
}

model::WorstElement BodyForces::evaluate(const Field& u, Field& f) const {
    model::WorstElement worst;
    if (dynamics_ == nullptr) {
        f.assign(u.size(), Vec3::Zero());
        model_.K.multiply_add(u, f, threads_);
        if (nonlinear()) worst = model_.finite_strain->add_internal_force(model_.X, u, f, threads_);
        return worst;
    }
    f = force_start_;
    (nonlinear() ? constant_ : tangent_).multiply_add(weighted(1, u, -1, u_start_), f, threads_);
    if (nonlinear()) worst = model_.finite_strain->add_step_force(model_.X, u_start_, u, mean_, f, threads_);
    return worst;
}

bool BodyForces::linearise(const Field& u) {
    if (!nonlinear()) return false;
    tangent_ = constant_;
    if (dynamics_ == nullptr)
        model_.finite_strain->add_tangent(model_.X, u, tangent_, threads_);
    else
        model_.finite_strain->add_step_tangent(model_.X, u_start_, u, mean_, tangent_, threads_);
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

BodyWork BodyForces::work(const model::State& state) const {
    const Integrator& w = dynamics_->integrator;
    const Field Du = weighted(1, state.u, -1, u_start_);
    BodyWork work;
    Field f(Du.size(), Vec3::Zero());
    mass().multiply_add(weighted(1 - w.alpha_m, state.a, w.alpha_m, a_start_), f, threads_);
    work.inertia = dot(Du, f);

    f.assign(f.size(), Vec3::Zero());
    model_.K.multiply_add(weighted(1 - w.alpha_f, state.u, w.alpha_f, u_start_), f, threads_);
    const auto add_step = [&](const fe::StepMean& mean) {
        (void)model_.finite_strain->add_step_force(model_.X, u_start_, state.u, mean, f, threads_);
    };
    if (nonlinear()) add_step({mean_.end_weight, 0});
    work.internal = dot(Du, f);

    f.assign(f.size(), Vec3::Zero());
    add_damping(model_, *dynamics_, weighted(1 - w.alpha_f, state.v, w.alpha_f, v_start_), f, threads_);
    work.damping = dot(Du, f);
    if (nonlinear() && mean_.viscosity > 0) { // what the viscous stress adds
        f.assign(f.size(), Vec3::Zero());
        add_step(mean_);
        work.damping += dot(Du, f);
        f.assign(f.size(), Vec3::Zero());
        add_step({mean_.end_weight, 0});
        work.damping -= dot(Du, f);
    }
    return work;
}

Field body_forces(const model::Model& model, const Dynamics& dynamics, const model::State& state, int threads) {
    Field f = model::internal_force(model, state.u, threads);
    add_damping(model, dynamics, state.v, f, threads);
    return f;
}

} // namespace osculate::time
