#pragma once
/// Whether the forces of an accepted step balance.

#include "osculate/equilibrium/equilibrium.hpp"
#include "osculate/model/model.hpp"

namespace osculate::time {

/// Forces of a step, N. Of every body, supports, loads, contact and inertia add up to nothing where internal forces do;
/// of every pair, the forces on both sides where contact neither pushes nor pulls the whole.
struct ForceBalance {
    double left_over = 0; ///< largest sum of a body or pair
    double acting = 0;    ///< sum of the magnitudes of all nodal forces, at least the solver's reference force
};

/// @param equilibrium  at its last residual, the one of `state`, and not committed to another step
/// @param state        what that step ended in. A pair with mirror images is judged by its bodies alone: what a symmetry
///                     plane carries does not show in the forces on nodes
[[nodiscard]] ForceBalance force_balance(const model::Model& model, const equilibrium::Equilibrium& equilibrium,
                                         const model::State& state);

} // namespace osculate::time
