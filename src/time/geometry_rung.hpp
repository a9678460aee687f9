#pragma once

#include "osculate/time/solve_ladder.hpp"

namespace osculate::time {

/// Solves with the geometry of contact held, by settle_friction(), and holds it anew at each solution: partners, normals and
/// weights are then those of the solution before, as in time stepping that linearises contact at the start of a step. So what
/// goes round between facets, edges and their normals comes to an end. If the solution no longer moves, the equations are met
/// as they are; else the last one counts if the geometry there is near enough to the one that was held, and
/// LadderResult::held_geometry says so.
/// @param z         start values; last iterate afterwards
/// @param statuses  to start from
[[nodiscard]] LadderResult settle_geometry(equilibrium::Equilibrium& equilibrium, solve::KinsolSolver& solver,
                                           Vector& z, const equilibrium::Statuses& statuses, LadderOptions& options);

} // namespace osculate::time
