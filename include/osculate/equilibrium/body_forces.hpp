#pragma once
/// Inertia, damping, internal forces and follower pressures of all bodies over one step: everything except dead loads
/// and contact.

#include "osculate/equilibrium/dynamics.hpp"
#include "osculate/equilibrium/weights.hpp"
#include "osculate/fe/element_block.hpp"
#include "osculate/linear/dependence.hpp"
#include "osculate/mesh/surface_faces.hpp"
#include "osculate/model/model.hpp"

#include <functional>

namespace osculate::equilibrium {

/// Work of the body forces over the displacements of a step, J.
struct BodyWork {
    double inertia = 0, internal = 0, damping = 0;
    double stiffness_damping = 0; ///< the part of `damping` that is not proportional to mass
    double follower = 0;          ///< work of the follower pressures on the bodies
};

/// A pressure that follows its faces over a step.
struct FollowerLoad {
    const std::vector<mesh::SurfaceFace>* faces = nullptr; ///< global nodes
    double start = 0, end = 0;                             ///< Pa
};

/// Springs that hold every node of all bodies at its place, in proportion to its share of its body's volume: the forces
///     s_i k (u_i - a_i).
/// They support bodies that nothing else holds yet; no equilibrium is accepted while they act.
struct Stabilisation {
    const std::vector<double>* share = nullptr; ///< s_i, see model::volume_shares
    double stiffness = 0;                       ///< k, sum over the springs of one body, N/m
    Field anchor{};                             ///< a_i, (nodes) m
};

/// In statics f(u) = f_int(u) - f_p(u), with the forces f_p of follower pressures and f_int at the end of the step, see
/// fe::ElementKernel::update. In dynamics the mean over the step that the integrator requires,
///     f(u) = (1-alpha_m) M a + alpha_m M a_n + (1-alpha_f) (C v + K u - f_p) + alpha_f (C v_n + K u_n - f_p,n),
/// v and a affine in u by its kinematics, C = mass_damping M + stiffness_damping K. For nonlinear elements, the forces
/// of fe::ElementKernel::update with a mean and end_weight = 1-alpha_f replace K u and stiffness damping. If alpha_f
/// and alpha_m are 1/2, they conserve energy and momenta for every dt; the mean of the forces at both ends would add
/// energy to a body under large rotations.
class BodyForces {
public:
    /// @param dynamics           null in statics; must outlive this object, like the model
    /// @param follower_pressure  whether any step may have follower pressures
    BodyForces(const model::Model& model, const Dynamics* dynamics, bool follower_pressure, int threads);

    /// Part of the tangent that other terms add at every linearise(), which is then not symmetric.
    /// @param dependence  what nodes with follower pressures may depend on; it must outlive this object
    void add_to_tangent(std::function<void(linear::BlockMatrix&)> part, const linear::Dependence& dependence);
    /// Opens a step. True if this changed the tangent.
    /// @param temperature  (nodes) at its end, see StepLoad; empty: none
    bool begin(const model::State& state, std::vector<FollowerLoad> pressures, const std::vector<double>& temperature,
               double dt);
    /// Adds or changes springs, in statics. Afterwards tangent() is another matrix.
    void stabilise(Stabilisation springs);
    /// Removes the springs; tangent() is again the matrix without them.
    void release();
    [[nodiscard]] bool stabilised() const { return springs_.share != nullptr; }
    /// f (nodes) N at u (nodes) m; do not use f if an element is not admissible.
    model::WorstElement evaluate(const Field& u, Field& f) const;
    /// Adds to `terms`, (nodes) N, the absolute values of the summands of f(u), from the current tangent: the round-off
    /// of f is a few last digits of these sums.
    void add_terms(const Field& u, Field& terms) const;
    /// Updates the tangent to u. False if it does not depend on u; then nothing is done.
    bool linearise(const Field& u);
    /// df/du at the last linearise(): the effective stiffness.
    [[nodiscard]] const linear::BlockMatrix& tangent() const {
        return dynamics_ || varies() || stabilised() ? tangent_ : model_.K;
    }
    /// Whether several processes share the rows of tangent().
    [[nodiscard]] bool shared() const { return model_.share != nullptr; }
    [[nodiscard]] bool dynamic() const { return dynamics_ != nullptr; }
    /// Factor (1 - alpha_m) da/du of M in the tangent of the attempt, 1/s^2; 0 in statics.
    [[nodiscard]] double mass_factor() const {
        return dynamic() ? (1 - dynamics_->integrator.alpha_m) * kinematics_.by_u_acceleration : 0;
    }
    [[nodiscard]] bool symmetric() const {
        return !follower_pressure_ && !also_ && (dynamics_ == nullptr || !nonlinear());
    }
    /// Whether the tangent is never indefinite: it can at most be singular.
    [[nodiscard]] bool semidefinite() const { return symmetric() && !nonlinear(); }

    /// Computes velocities, accelerations and element histories at the end of the step from the displacements there; no
    /// velocities or accelerations in statics.
    void complete(model::State& state) const;
    /// Adds to weights of the displacements at the end of the step those of velocities and accelerations there, which are affine in
    /// them.
    void add_weights_of_motion(const StateWeights& end, Field& by_u) const;
    /// Adds the weights that the state at the start has by weights of forces f (nodes), and by those of velocities and accelerations
    /// at the end, all at fixed displacements u there. @pre dynamics without follower pressures, and where elements are nonlinear without
    /// stiffness damping
    void add_transposed_of_start(const Field& u, const Field& of, const StateWeights& end, StateWeights& start) const;
    /// y += A^T x, A the tangent.
    void multiply_add_transposed(const Field& x, Field& y) const;
    /// Inertia part of the tangent: d/du of the force in one direction, summed over the row of a node, N/m.
    [[nodiscard]] double inertia(Index node) const;
    /// Work over the step that ended in `state`.
    [[nodiscard]] BodyWork work(const model::State& state) const;
    /// External forces of that step except dead loads: follower pressures minus inertia and mass damping. (nodes) N;
    /// empty if there are none of these
    [[nodiscard]] Field outer_forces(const model::State& state) const;

private:
    [[nodiscard]] bool nonlinear() const { return model_.nonlinear != nullptr; }
    /// Whether the tangent depends on u.
    [[nodiscard]] bool varies() const { return nonlinear() || follower_pressure_ || also_; }
    [[nodiscard]] model::BodyStep step_to(const Field& u) const { return {u_start_, u, history_start_, mean_}; }
    /// f += factor times the forces of the pressures, with their values at the start or the end of the step.
    void add_pressures(double factor, bool end, const Field& u, Field& f) const;
    /// add_terms() of the rows that A has.
    void add_own_terms(const linear::BlockMatrix& A, const Field& u, Field& terms) const;
    void add_springs(linear::BlockMatrix& tangent) const;
    /// Adds the tangent of a pressure on a face to that of all forces.
    void add_pressure_tangent(const mesh::SurfaceFace& face, const Field& x, double pressure);
    [[nodiscard]] const linear::BlockMatrix& mass() const { return model_.mass(dynamics_->lumped_mass); }

    const model::Model& model_;
    const Dynamics* dynamics_;
    bool follower_pressure_;
    int threads_;
    std::function<void(linear::BlockMatrix&)> also_; ///< see add_to_tangent(); null: nothing
    const linear::Dependence* dependence_ = nullptr; ///< the same
    std::vector<FollowerLoad> pressures_;
    Kinematics kinematics_;        ///< of the current dt
    std::vector<double> row_mass_; ///< (nodes) sums of the rows of the mass matrix, kg; dynamics only
    double dt_ = 0;
    Integrator rule_;                  ///< of the current attempt
    std::optional<fe::StepMean> mean_; ///< for nonlinear elements, with the current dt; none in statics
    model::MaterialHistory history_start_;
    Stabilisation springs_;        ///< no share: no springs
    linear::BlockMatrix tangent_;  ///< in dynamics, if it varies, or with springs
    linear::BlockMatrix constant_; ///< if it varies: the part of the tangent that does not depend on u
    Field u_start_;                ///< in statics only if elements have a history
    Field v_start_, a_start_;      ///< dynamics only
    Field force_start_;            ///< f at u_start without nonlinear elements, N; dynamics only
};

/// Adds the forces of follower pressures at u, (nodes) N, with the pressures at the start of the step.
void add_follower_forces(const std::vector<FollowerLoad>& pressures, const model::Model& model, const Field& u,
                         Field& f);

/// f_int(u) + C v of a state in dynamics, at finite strain without stiffness damping, (nodes) N.
[[nodiscard]] Field body_forces(const model::Model& model, const Dynamics& dynamics, const model::State& state,
                                int threads);

} // namespace osculate::equilibrium
