#pragma once
/// The energy balance of a dynamic run.

#include "osculate/equilibrium/equilibrium.hpp"
#include "osculate/model/model.hpp"
#include "osculate/time/stage.hpp"

namespace osculate::time {

/// Current energies; work and dissipation since the start of the first dynamic stage, J; momenta, kg m/s and kg m^2/s.
///     kinetic + strain - (both at the start) = external + contact - friction - damping - algorithmic + balance
/// The contribution of each step to a member is the work of one term of the discrete equations of motion over the
/// step's displacement Du, so that `balance` is the work of the solver's residual, Du . F.
struct Ledger {
    double kinetic = 0, strain = 0; ///< strain energy also of interfaces that give way ...
    double interface = 0;           ///< ... which is this part of it
    double external = 0;            ///< loads, supports, driven motions and changes of laws
    double friction = 0;            ///< dissipated, >= 0
    double damping = 0;             ///< dissipated, by damping, by inelastic impacts and by plastic flow ...
    double settling = 0;            ///< ... of which stiffness damping and inelastic impacts took this
    double algorithmic =
        0; ///< dissipated by the integrator: work of inertia and stiffness beyond their energies' change
    /// Work of normal contact forces beyond what interfaces store, and what the integrator takes of the energy where nodes of
    /// such interfaces come into contact; 0 while bodies stay in contact, > 0 is spurious energy.
    double contact = 0;
    double balance = 0;
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero(); ///< momenta, angular about the origin in current positions
};

/// The ledger of the initial state.
[[nodiscard]] Ledger opened(const model::Model& model, const equilibrium::Dynamics& dynamics,
                            const model::State& state);

/// At the start of a stage that may change pairs and their laws: what that does to the energy of interfaces is external work.
void revalue_interfaces(Ledger& ledger, const model::Model& model, const model::State& state);

/// The ledger after a step.
/// @param equilibrium  at its last residual, that of `to`
/// @param force        (nodes) external forces of the step's equations, N
/// @param impact       all that the step takes beyond friction is damping
[[nodiscard]] Ledger advanced(const Ledger& ledger, const model::Model& model, const equilibrium::Dynamics& dynamics,
                              const equilibrium::Equilibrium& equilibrium, const model::State& from,
                              const model::State& to, const Field& force, bool impact = false);

} // namespace osculate::time
