#pragma once
/// Decides what pairs leave to the program: which side is the slave, and the discretisation.

#include "app/plan/draft.hpp"

namespace osculate::app {

/// Stiffness of one side over the other from which it weighs more than which side is meshed finer.
inline constexpr double much_stiffer = 100;

/// Fills in the roles of pairs that name two sides, and the discretisation of those that give none; says why in
/// Plan::choices. Needs the sets.
void settle_pairs(Draft& draft);

} // namespace osculate::app
