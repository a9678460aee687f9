#pragma once

#include "osculate/time/solve_ladder.hpp"

namespace osculate::time {

/// Solves by equilibrium::FrictionStep, again and again, which meets contact and friction exactly and linearises the rest.
/// Once the statuses stay, semismooth Newton is tried from there.
/// @param z         start values; last iterate afterwards
/// @param statuses  to start from
[[nodiscard]] LadderResult settle_friction(equilibrium::Equilibrium& equilibrium, solve::KinsolSolver& solver,
                                           Vector& z, const equilibrium::Statuses& statuses, LadderOptions& options);

} // namespace osculate::time
