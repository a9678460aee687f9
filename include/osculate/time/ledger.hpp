#pragma once
/// Where the energy of a dynamic run is and where it has gone.

#include "osculate/equilibrium/equilibrium.hpp"
#include "osculate/model/model.hpp"
#include "osculate/time/stage.hpp"

namespace osculate::time {

/// Energies now, work and dissipation since the first dynamic stage began, J; momenta, kg m/s and kg m^2/s.
///     kinetic + strain - (both at the start) = external + contact - friction - damping - algorithmic + balance
/// Every share of a step is the work of one term of the discrete equations of motion over the step's displacement Du, so
/// that `balance` is what the solver left unsolved, Du . F.
struct Ledger {
    double kinetic = 0, strain = 0;
    double external = 0; ///< loads, supports and driven motions
    double friction = 0; ///< dissipated, >= 0
    double damping = 0;  ///< dissipated
    double algorithmic =
        0;              ///< dissipated by the integrator: what inertia and stiffness do beyond their energies' change
    double contact = 0; ///< work of normal contact forces; 0 where bodies stay in touch, > 0 is energy out of nowhere
    double balance = 0;
    Vec3 linear = Vec3::Zero(), angular = Vec3::Zero(); ///< momenta, angular about the origin in current positions
};

/// The ledger of a state nothing has happened to yet.
[[nodiscard]] Ledger opened(const model::Model& model, const equilibrium::Dynamics& dynamics,
                            const model::State& state);

/// The ledger after a step.
/// @param equilibrium  at its last residual, the one of `to`
/// @param force        (nodes) external forces of the step's equations, N
[[nodiscard]] Ledger advanced(const Ledger& ledger, const model::Model& model, const equilibrium::Dynamics& dynamics,
                              const equilibrium::Equilibrium& equilibrium, const model::State& from,
                              const model::State& to, const Field& force);

} // namespace osculate::time
