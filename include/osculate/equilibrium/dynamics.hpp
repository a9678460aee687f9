#pragma once
/// Options of inertia and damping in a stage.

#include "osculate/equilibrium/integrator.hpp"

namespace osculate::equilibrium {

/// Options of a dynamic stage.
struct Dynamics {
    Integrator integrator;
    bool lumped_mass = false;
    double mass_damping = 0, stiffness_damping = 0; ///< C = mass_damping M + stiffness_damping K, 1/s and s
};

} // namespace osculate::equilibrium
