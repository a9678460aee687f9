#pragma once
/// Contact with Coulomb friction at n points, for a linear relation between motions and forces.

#include "osculate/core/types.hpp"

namespace osculate::solve {

/// Find r with  u = W r + q  and at every point j, in its local components (normal, two tangents),
///     0 <= r_N  _|_  u_N >= 0,    |r_T| <= mu r_N,    r_T = -mu r_N u_T/|u_T| where u_T is not zero.
struct FrictionProblem {
    Matrix W;  ///< (3n x 3n) m/N, positive semidefinite or nearly so; need not be symmetric
    Vector q;  ///< (3n) m, gaps and tangential displacements without forces
    Vector mu; ///< (n) Coulomb's coefficients

    [[nodiscard]] Index points() const { return static_cast<Index>(mu.size()); }
};

struct FrictionSolution {
    Vector r;               ///< (3n) N
    double error = 0;       ///< see friction_error()
    int iterations = 0;     ///< factorisations of (3n x 3n) matrices
    bool converged = false; ///< the error is within the tolerance
};

/// Distance from a solution: |r - P(r - rho (u + mu |u_T| n))| / |rho q|, where P is the projection on the friction cones
/// and rho_j = 1/max diag W_jj. It is zero if and only if r is a solution.                     [De Saxce & Feng 1998]
[[nodiscard]] double friction_error(const FrictionProblem& problem, const Vector& r);

/// Solves it by a nonsmooth Newton method with a line search and, if that fails, by convex problems on the friction cones,
/// each of which takes the sliding distances of the one before as given; Newton then starts from their solutions. It ends
/// once neither errors nor changes of settled distances become smaller, or after a thousand factorisations. The
/// solution need not be unique, but the same input gives the same bits. O(n^3) an iteration.
[[nodiscard]] FrictionSolution solve_friction(const FrictionProblem& problem, double tolerance);

} // namespace osculate::solve
