#pragma once
/// Inertia, damping and internal forces of all bodies over one step, all forces but loads and contact.

#include "osculate/model/model.hpp"
#include "osculate/time/stage.hpp"

namespace osculate::time {

/// Work of the body forces over the displacements of a step, J.
struct BodyWork {
    double inertia = 0, internal = 0, damping = 0;
};

/// In statics f(u) = f_int(u). In dynamics the mean over the step that the integrator asks for,
///     f(u) = (1-alpha_m) M a + alpha_m M a_n + (1-alpha_f) (C v + f_int(u)) + alpha_f (C v_n + f_int(u_n)),
/// v and a affine in u by its kinematics, C = mass_damping M + stiffness_damping K. For bodies at finite strain K of the
/// damping is the tangent at the start of the step, so that a rigid rotation is damped by nothing.
class BodyForces {
public:
    /// @param dynamics  null in statics; must outlive this object, as must the model
    BodyForces(const model::Model& model, const Dynamics* dynamics, int threads);

    /// Opens a step. True where it changed the tangent.
    bool begin(const model::State& state, double dt);
    /// f (nodes) N at u (nodes) m; not to be used where an element is not admissible.
    model::WorstElement evaluate(const std::vector<Vec3>& u, std::vector<Vec3>& f) const;
    /// Takes the tangent to u. False where it does not depend on u, and nothing is done.
    bool linearise(const std::vector<Vec3>& u);
    /// df/du, at the last linearise(): the effective stiffness.
    [[nodiscard]] const model::BlockMatrix& tangent() const { return dynamics_ || nonlinear() ? tangent_ : model_.K; }

    /// Velocities and accelerations at the end of the step from the displacements there; empty in statics.
    void complete(model::State& state) const;
    /// Share of the inertia in the tangent, d/du of one direction's force summed over the row of a node, N/m.
    [[nodiscard]] double inertia(Index node) const;
    /// Work over the step that ended in `state`.
    [[nodiscard]] BodyWork work(const model::State& state) const;
    /// f_int(u) + C v of a state, (nodes) N. Not between begin() and the end of its step.
    [[nodiscard]] std::vector<Vec3> of(const model::State& state);

private:
    using Field = std::vector<Vec3>;
    [[nodiscard]] bool nonlinear() const { return model_.finite_strain != nullptr; }
    [[nodiscard]] const model::BlockMatrix& mass() const { return model_.mass(dynamics_->lumped_mass); }
    [[nodiscard]] bool damps_strain() const { return nonlinear() && dynamics_->stiffness_damping > 0; }
    /// f += C v
    void add_damping(const Field& v, Field& f) const;
    void set_tangent_of_damping(const Field& u);

    const model::Model& model_;
    const Dynamics* dynamics_;
    int threads_;
    Kinematics kinematics_; ///< of the current dt
    double dt_ = 0;
    model::BlockMatrix tangent_;        ///< dynamics or finite strain
    model::BlockMatrix constant_;       ///< finite strain: the part of the tangent that does not depend on u
    model::BlockMatrix damping_;        ///< finite strain with stiffness damping: df_int/du at the start of the step
    Field u_start_, v_start_, a_start_; ///< dynamics only
    Field force_start_;                 ///< f at u_start without f_int of finite strain at the end, N; dynamics only
    Field internal_start_;              ///< f_int of finite strain at u_start, N
};

} // namespace osculate::time
