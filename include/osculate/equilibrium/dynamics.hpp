#pragma once
/// Options of inertia and damping in a stage.

#include "osculate/equilibrium/integrator.hpp"

namespace osculate::equilibrium {

/// Options of a dynamic stage.
struct Dynamics {
    Integrator integrator;
    bool lumped_mass = false;
    double mass_damping = 0, stiffness_damping = 0; ///< C = mass_damping M + stiffness_damping K, 1/s and s
    /// In which bodies that general contact finds inside one another at the start of an attempt come out, s; 0: in that step.
    double recovery_time = 0;
};

} // namespace osculate::equilibrium
