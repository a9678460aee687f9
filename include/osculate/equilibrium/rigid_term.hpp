#pragma once
/// Rigid bodies and couplings: what their nodes follow, and the inertia of rigid bodies as a term of the residual.

#include "osculate/equilibrium/term.hpp"
#include "osculate/linear/dependence.hpp"

namespace osculate::equilibrium {

/// The unknowns of a body in a step are the displacement u_r of its reference point and the rotation vector theta of the
/// step, R = exp([theta]) R_n. Its mesh has x_i = x_r + rho_i with rho_i = R (X_i - X_r). Forces f_i on the mesh act on
/// the body as their sum and as the moment
///     sum_i [(1-alpha_f) rho_i + alpha_f rho_i,n] x f_i,
/// in statics alpha_f = 0. In dynamics, with c Cayley's vector of theta, W the angular velocity and A its rate in body
/// axes, p = R J W, and v, a affine in u by the integrator's kinematics,
///     v_c, a_c of Dx_c;   W, A of R_n^T c;   dp/dt = (p - p_n)/(gamma dt) - (1-gamma)/gamma (dp/dt)_n
///     force f = m [(1-alpha_m) a_c + alpha_m a_c,n],
///     moment (1-alpha_m) dp/dt + alpha_m (dp/dt)_n + [(1-alpha_f) rho_c + alpha_f rho_c,n] x f.
/// Since x_i - x_i,n = Du_r + c x (rho_i + rho_i,n)/2, the work of all these is exact for alpha_m = alpha_f = 1/2, beta =
/// 1/4, gamma = 1/2, and energy and both momenta of a free body are conserved.                     [Simo & Wong 1991]
/// Where the reference point is held and the centre is elsewhere, v_c and W would be two velocities of one motion, and
/// drift apart. There v_r of Du_r takes the place of v_c,
///     q = m (v_r + b), b = w x rho_c,   l = R J_r W + m rho_c x v_r,   dq/dt and dl/dt as dp/dt above
///     force (1-alpha_m) dq/dt + alpha_m (dq/dt)_n,
///     moment (1-alpha_m) dl/dt + alpha_m (dl/dt)_n + m/4 [(v_r,n + Q v_r,n) x b + (v_r + Q^T v_r) x b_n], Q = R R_n^T,
/// whose work is exact in the same way; about a point at rest the angular momentum is, too.
/// Couplings have no inertia here: that of their nodes is a force on these like any other, whose work is exact with it.
class RigidTerm final : public Term {
public:
    /// @param dynamics  null in statics; must outlive this object, like the model
    RigidTerm(const model::Model& model, const linear::Constraints& constraints, const Dynamics* dynamics);

    /// Sets the displacements of the meshes of rigid bodies from those of their own nodes, (nodes) m.
    void place(Field& u) const;
    /// What depends on what at the last renew().
    [[nodiscard]] const linear::Dependence& dependence() const { return dependence_; }
    /// Renews the dependence to placed displacements. False if a body turns by half a turn or more in the step.
    [[nodiscard]] bool renew(const Field& u);
    /// Moves all forces on the left of the equilibrium to the bodies' own nodes, and keeps how their moments change when
    /// the bodies turn.
    void fold(Field& f);
    /// Adds the derivatives at the last fold() to a matrix that has the couplings of the bodies' own nodes.
    void add_tangent(linear::BlockMatrix& tangent) const;

    /// Work of inertia over the step that ended at the last evaluate(), J.
    [[nodiscard]] double work_of_inertia() const;
    /// Work of the forces of the last fold() as their nodes move, less that of what acts on the bodies: forces that are
    /// means over a step act on means of their arms, whose weights are others than those of the motion.
    [[nodiscard]] double work_of_weights() const;
    /// Force of inertia on the left of the equilibrium of a body, in dynamics, N.
    [[nodiscard]] Vec3 inertia_force(std::size_t body) const { return bodies_[body].force; }
    /// Sum of what equations exert on the nodes of each body, and on its reference point, at the last fold(), N; empty
    /// without equations.
    [[nodiscard]] const std::vector<Vec3>& led_force() const { return led_force_; }
    /// Replaces the increment of each body's rotation node by the one whose product with the moment is the work.
    void make_conjugate(Field& Du) const;

    [[nodiscard]] std::string_view name() const override { return "rigid bodies"; }
    bool begin(const model::State& state, const Iterate& at, const StepLoad& load, double dt) override;
    [[nodiscard]] bool evaluate(const Iterate& at) override;
    void add_forces(Field& f) const override;
    void add_magnitudes(const Iterate& at, Field& sums) const override;
    void linearise(const Iterate&) override {}
    void add_product(const Direction&, Field&, VectorRef) override {} // its tangent is part of the bodies'
    void complete(const ConstVectorRef& z, model::State& state) const override;

private:
    /// A body in the step: at its start, and at the last renew().
    struct Moving {
        model::RigidMotion start;
        Vec3 u_start = Vec3::Zero(), angles_start = Vec3::Zero(); ///< of its two nodes, m
        Mat3 R_start = Mat3::Identity(), R = Mat3::Identity();
        Vec3 Du = Vec3::Zero(), theta = Vec3::Zero(), c = Vec3::Zero();
        Mat3 T = Mat3::Identity(); ///< dR = [T dtheta] R
        model::RigidMotion end;
        Vec3 force = Vec3::Zero(), moment = Vec3::Zero(); ///< of inertia; the moment about the reference point
        Mat3 force_by_r, force_by_theta, moment_by_r, moment_by_theta; ///< its derivatives, in dynamics
        Vec3 swept = Vec3::Zero();                                     ///< sum of (rho_i - rho_i,n) x f_i
        Mat3 turning = Mat3::Zero(); ///< change of the moment of all forces on the mesh by dtheta
    };
    /// Takes body k to displacements of its two nodes. False, and nothing is done, if it turns by half a turn or more.
    [[nodiscard]] bool move(std::size_t k, const Field& u, Moving& now) const;
    /// Gives a coupling its mean velocity over the step, for predictors: its unknowns have no mass, and velocities by
    /// the integrator's kinematics would oscillate.
    void set_mean_velocity(Moving& now) const;
    /// Sets velocities, accelerations and inertia of a moved body, in dynamics: in terms of its centre, or of its
    /// reference point.
    void set_inertia_of_centre(const model::RigidBody& body, Moving& now) const;
    void set_inertia_of_reference(const model::RigidBody& body, Moving& now) const;
    [[nodiscard]] Vec3 centre_arm(const model::RigidBody& body, const Mat3& R) const;

    const model::Model& model_;
    const Dynamics* dynamics_;
    Kinematics kinematics_;
    double dt_ = 0, alpha_f_ = 0;
    std::vector<Moving> bodies_;
    std::vector<char> by_reference_; ///< (bodies) whether inertia is taken in terms of the reference point
    linear::Dependence dependence_;
    std::vector<Vec3> led_force_; ///< (bodies of the model)
};

/// Accelerations of rigid bodies where motion begins, and the velocities that supports leave them.
/// @param force  (nodes) dead loads and contact forces at the start, N
void start_rigid_motion(const model::Model& model, const linear::Constraints& constraints, const Field& force,
                        model::State& state);

} // namespace osculate::equilibrium
