#pragma once

#include "osculate/solve/friction_problem.hpp"

namespace osculate::solve {

/// Fixed point iteration over sliding distances s: with s given, De Saxce's correction is a constant, and what is left is
///     R in K,   W R + q + mu s n in the dual of K,   orthogonal:
/// a convex problem on second-order cones, which an interior point method solves. After each of them Newton's method is
/// tried from its solution.
/// @param most_iterations  of the interior point method, in all
[[nodiscard]] FrictionSolution cone_friction(const FrictionProblem& problem, double tolerance, int most_iterations);

} // namespace osculate::solve
