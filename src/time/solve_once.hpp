#pragma once

#include "osculate/time/solve_ladder.hpp"

namespace osculate::time {

/// One KINSOL call. A call that comes to rest at the round-off of every row counts as converged, see Equilibrium::rests().
/// So does one that comes to rest at the round-off of the internal forces as a whole, with a larger reference force from
/// then on.
/// @param rule  of the statuses, which go on from where it came to rest
[[nodiscard]] solve::KinsolResult solve_once(equilibrium::Equilibrium& equilibrium, solve::KinsolSolver& solver,
                                             Vector& z, equilibrium::StatusRule rule, LadderOptions& options);

} // namespace osculate::time
