#pragma once

#include "osculate/solve/friction_problem.hpp"

namespace osculate::solve {

/// Semismooth Newton method for r - P(r - rho u) in the form of Alart and Curnier, with a line search on its norm.
/// @param r  (3n) start values
[[nodiscard]] FrictionSolution newton_friction(const FrictionProblem& problem, Vector r, double tolerance,
                                               int most_iterations);

} // namespace osculate::solve
