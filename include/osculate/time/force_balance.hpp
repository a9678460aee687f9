#pragma once
/// Checks that the forces of an accepted step balance.

#include "osculate/equilibrium/equilibrium.hpp"
#include "osculate/model/model.hpp"

namespace osculate::time {

/// Forces of a step, N. For every body, the forces of supports, loads, contact and inertia sum to zero if internal
/// forces do; for every pair, the forces on both sides sum to zero if contact causes no net force.
struct ForceBalance {
    double left_over = 0; ///< largest sum of a body or pair
    double acting = 0;    ///< sum of the magnitudes of all nodal forces, not less than the solver's reference force
};

/// @param equilibrium  at its last residual, that of `state`, with no other step opened since
/// @param state        result of that step. For a pair with mirror images only the bodies are checked: the nodal forces
///                     do not contain the force of a symmetry plane
[[nodiscard]] ForceBalance force_balance(const model::Model& model, const equilibrium::Equilibrium& equilibrium,
                                         const model::State& state);

} // namespace osculate::time
