#pragma once
/// Inertia, damping, internal forces and follower pressures of all bodies over one step: all but dead loads and contact.

#include "osculate/equilibrium/dynamics.hpp"
#include "osculate/fe/element_block.hpp"
#include "osculate/mesh/surface_faces.hpp"
#include "osculate/model/model.hpp"

namespace osculate::equilibrium {

/// Work of the body forces over the displacements of a step, J.
struct BodyWork {
    double inertia = 0, internal = 0, damping = 0;
    double follower = 0; ///< of the follower pressures on the bodies
};

/// A pressure that follows its faces over a step.
struct FollowerLoad {
    const std::vector<mesh::SurfaceFace>* faces = nullptr; ///< global nodes
    double start = 0, end = 0;                             ///< Pa
};

/// Springs that hold every node of all bodies to where it was, in proportion to its share of its body's volume: the forces
///     s_i k (u_i - a_i).
/// Something to lean on for bodies that nothing else holds yet; no equilibrium is accepted with them in place.
struct Stabilisation {
    const std::vector<double>* share = nullptr; ///< s_i, see model::volume_shares
    double stiffness = 0;                       ///< k, of all springs of one body together, N/m
    Field anchor{};                             ///< a_i, (nodes) m
};

/// In statics f(u) = f_int(u) - f_p(u), f_p those of follower pressures, f_int at the end of the step, see
/// fe::ElementKernel::update. In dynamics the mean over the step that the integrator asks for,
///     f(u) = (1-alpha_m) M a + alpha_m M a_n + (1-alpha_f) (C v + K u - f_p) + alpha_f (C v_n + K u_n - f_p,n),
/// v and a affine in u by its kinematics, C = mass_damping M + stiffness_damping K. Nonlinear elements have in place of K u
/// and stiffness damping the forces that fe::ElementKernel::update has with a mean, with end_weight = 1-alpha_f: with alpha_f =
/// alpha_m = 1/2 they conserve energy and momenta for every dt, where the mean of the forces at the two ends, under large
/// rotations, feeds energy into a body out of nowhere.
class BodyForces {
public:
    /// @param dynamics  null in statics; must outlive this object, as must the model
    /// @param follower_pressure  whether steps may have any
    BodyForces(const model::Model& model, const Dynamics* dynamics, bool follower_pressure, int threads);

    /// Opens a step. True where it changed the tangent.
    bool begin(const model::State& state, std::vector<FollowerLoad> pressures, double dt);
    /// Adds springs, or changes them, in statics. tangent() is another matrix afterwards.
    void stabilise(Stabilisation springs);
    /// Takes them away; tangent() is the one it was before.
    void release();
    [[nodiscard]] bool stabilised() const { return springs_.share != nullptr; }
    /// f (nodes) N at u (nodes) m; not to be used where an element is not admissible.
    model::WorstElement evaluate(const Field& u, Field& f) const;
    /// Adds to `terms`, (nodes) N, the absolute values of what f(u) is summed up from: its round-off is some last digits of
    /// that. By the tangent as it is.
    void add_terms(const Field& u, Field& terms) const;
    /// Takes the tangent to u. False where it does not depend on u, and nothing is done.
    bool linearise(const Field& u);
    /// df/du, at the last linearise(): the effective stiffness.
    [[nodiscard]] const linear::BlockMatrix& tangent() const {
        return dynamics_ || varies() || stabilised() ? tangent_ : model_.K;
    }
    [[nodiscard]] bool dynamic() const { return dynamics_ != nullptr; }
    [[nodiscard]] bool symmetric() const { return !follower_pressure_ && (dynamics_ == nullptr || !nonlinear()); }

    /// Velocities, accelerations and what elements carry on at the end of the step from the displacements there; without
    /// velocities in statics.
    void complete(model::State& state) const;
    /// Share of the inertia in the tangent, d/du of one direction's force summed over the row of a node, N/m.
    [[nodiscard]] double inertia(Index node) const;
    /// Work over the step that ended in `state`.
    [[nodiscard]] BodyWork work(const model::State& state) const;
    /// What acts from outside of the bodies over that step but for dead loads: follower pressures, less inertia and damping
    /// by mass. (nodes) N; empty where there is neither
    [[nodiscard]] Field outer_forces(const model::State& state) const;

private:
    [[nodiscard]] bool nonlinear() const { return model_.nonlinear != nullptr; }
    /// Whether the tangent depends on u.
    [[nodiscard]] bool varies() const { return nonlinear() || follower_pressure_; }
    [[nodiscard]] model::BodyStep step_to(const Field& u) const { return {u_start_, u, history_start_, mean_}; }
    /// f += factor times the pressures' forces, each pressure that of the step's start or end.
    void add_pressures(double factor, bool end, const Field& u, Field& f) const;
    void add_springs(linear::BlockMatrix& tangent) const;
    [[nodiscard]] const linear::BlockMatrix& mass() const { return model_.mass(dynamics_->lumped_mass); }

    const model::Model& model_;
    const Dynamics* dynamics_;
    bool follower_pressure_;
    int threads_;
    std::vector<FollowerLoad> pressures_;
    Kinematics kinematics_; ///< of the current dt
    double dt_ = 0;
    std::optional<fe::StepMean> mean_; ///< of nonlinear elements, for the current dt; none in statics
    model::MaterialHistory history_start_;
    Stabilisation springs_;        ///< without share: none
    linear::BlockMatrix tangent_;  ///< dynamics, where it varies, or with springs
    linear::BlockMatrix constant_; ///< where it varies: the part of the tangent that does not depend on u
    Field u_start_;                ///< in statics where elements have a past
    Field v_start_, a_start_;      ///< dynamics only
    Field force_start_;            ///< f at u_start but for nonlinear elements, N; dynamics only
};

/// Adds the forces of follower pressures at u, (nodes) N, with their pressures at the start of the step.
void add_follower_forces(const std::vector<FollowerLoad>& pressures, const model::Model& model, const Field& u,
                         Field& f);

/// f_int(u) + C v of a state in dynamics, finite strain without stiffness damping, (nodes) N.
[[nodiscard]] Field body_forces(const model::Model& model, const Dynamics& dynamics, const model::State& state,
                                int threads);

} // namespace osculate::equilibrium
