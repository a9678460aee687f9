/// Transposed derivatives of a dynamic step by the state at its start.

#include "osculate/equilibrium/body_forces.hpp"

namespace osculate::equilibrium {

namespace {
/// y += A^T x
void add_transposed(const linear::BlockMatrix& A, const Field& x, Field& y) {
    for (Index i = 0; i < A.rows(); ++i)
        for (Index k = A.row_begin(i); k < A.row_end(i); ++k)
            y[static_cast<std::size_t>(A.column(k))].noalias() +=
                A.block(k).transpose() * x[static_cast<std::size_t>(i)];
}
} // namespace

void BodyForces::multiply_add_transposed(const Field& x, Field& y) const {
    if (dynamics_ != nullptr && nonlinear()) // means over a step: strains vary at its end, stresses act in between
        add_transposed(tangent(), x, y);
    else
        tangent().multiply_add(x, y, threads_);
}

void BodyForces::add_weights_of_motion(const StateWeights& end, Field& by_u) const {
    by_u.add(kinematics_.by_u_velocity, end.v);
    by_u.add(kinematics_.by_u_acceleration, end.a);
}

void BodyForces::add_transposed_of_start(const Field& u, const Field& of, const StateWeights& end,
                                         StateWeights& start) const {
    const Kinematics& k = kinematics_;
    start.u.add(-k.by_u_velocity, end.v);
    start.u.add(-k.by_u_acceleration, end.a);
    start.v.add(k.velocity_by_v, end.v);
    start.v.add(k.acceleration_by_v, end.a);
    start.a.add(k.velocity_by_a, end.v);
    start.a.add(k.acceleration_by_a, end.a);

    // f = (1-alpha_m) M a + alpha_m M a_n + (1-alpha_f) (C v + K u) + alpha_f (C v_n + K u_n); M, C and K are symmetric
    const Integrator& w = dynamics_->integrator;
    const double late = 1 - w.alpha_f, inertia = 1 - w.alpha_m;
    Field M(of.size()), K(of.size());
    mass().multiply_add(of, M, threads_);
    model_.K.multiply_add_relative(of, K, threads_);
    const Field C = weighted(dynamics_->mass_damping, M, dynamics_->stiffness_damping, K);
    start.u.add(-inertia * k.by_u_acceleration, M);
    start.u.add(-late * k.by_u_velocity, C);
    start.u.add(w.alpha_f, K);
    start.v.add(inertia * k.acceleration_by_v, M);
    start.v.add(late * k.velocity_by_v + w.alpha_f, C);
    start.a.add(inertia * k.acceleration_by_a + w.alpha_m, M);
    start.a.add(late * k.velocity_by_a, C);
    if (!nonlinear()) return;
    // forces of elements over a step are the same from its end to its start, with the weights of the two changed over
    linear::BlockMatrix by_start = model_.K;
    by_start.set_zero();
    model_.nonlinear->add_tangent(model_.X, {u, u_start_, history_start_, fe::StepMean{w.alpha_f, 0}}, by_start,
                                  threads_);
    add_transposed(by_start, of, start.u);
}

} // namespace osculate::equilibrium
