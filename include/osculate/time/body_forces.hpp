#pragma once
/// Inertia, damping and internal forces of all bodies over one step, all forces but loads and contact.

#include "osculate/fe/element_block.hpp"
#include "osculate/model/model.hpp"
#include "osculate/time/stage.hpp"

namespace osculate::time {

/// Work of the body forces over the displacements of a step, J.
struct BodyWork {
    double inertia = 0, internal = 0, damping = 0;
};

/// In statics f(u) = f_int(u). In dynamics the mean over the step that the integrator asks for,
///     f(u) = (1-alpha_m) M a + alpha_m M a_n + (1-alpha_f) (C v + K u) + alpha_f (C v_n + K u_n),
/// v and a affine in u by its kinematics, C = mass_damping M + stiffness_damping K. Bodies at finite strain have in place
/// of K u and stiffness damping the forces of fe::ElementKernel::step_force, with end_weight = 1-alpha_f: with alpha_f =
/// alpha_m = 1/2 they conserve energy and momenta for every dt, where the mean of the forces at the two ends, under large
/// rotations, feeds energy into a body out of nowhere.
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
    [[nodiscard]] bool symmetric() const { return dynamics_ == nullptr || !nonlinear(); }

    /// Velocities and accelerations at the end of the step from the displacements there; empty in statics.
    void complete(model::State& state) const;
    /// Share of the inertia in the tangent, d/du of one direction's force summed over the row of a node, N/m.
    [[nodiscard]] double inertia(Index node) const;
    /// Work over the step that ended in `state`.
    [[nodiscard]] BodyWork work(const model::State& state) const;

private:
    using Field = std::vector<Vec3>;
    [[nodiscard]] bool nonlinear() const { return model_.finite_strain != nullptr; }
    [[nodiscard]] const model::BlockMatrix& mass() const { return model_.mass(dynamics_->lumped_mass); }

    const model::Model& model_;
    const Dynamics* dynamics_;
    int threads_;
    Kinematics kinematics_; ///< of the current dt
    double dt_ = 0;
    fe::StepMean mean_;                 ///< of finite strain, for the current dt
    model::BlockMatrix tangent_;        ///< dynamics or finite strain
    model::BlockMatrix constant_;       ///< finite strain: the part of the tangent that does not depend on u
    Field u_start_, v_start_, a_start_; ///< dynamics only
    Field force_start_;                 ///< f at u_start but for finite strain, N; dynamics only
};

/// f_int(u) + C v of a state in dynamics, finite strain without stiffness damping, (nodes) N.
[[nodiscard]] std::vector<Vec3> body_forces(const model::Model& model, const Dynamics& dynamics,
                                            const model::State& state, int threads);

} // namespace osculate::time
