#pragma once
/// Algebraic multigrid for the stiffness of elastic bodies.

#include "osculate/solve/direct_solver.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace osculate::solve {

/// What multigrid has to know of a matrix beside its entries.
struct NodalUnknowns {
    std::vector<SparseIndex> equation; ///< (3 nodes) of each component, ascending; -1 held. No node with three of those
    Matrix near_kernel;                ///< (3 nodes x 6) motions that strain nothing, body by body in the same columns
};

/// V-cycles of smoothed aggregation, PETSc's GAMG. Grids are built once from matrices of bodies apart, so that no coarse
/// unknown joins two of them; what couples them enters the coarse matrices only.
class Multigrid {
public:
    virtual ~Multigrid() = default;
    /// @param A      symmetric positive definite; must stay alive and unchanged until the last cycle()
    /// @param apart  asked when the pattern of A is new, for values (nonzeros of A) to build grids from: without what couples
    ///               the bodies, and the same whenever it is asked, so that a solution does not depend on when that was
    [[nodiscard]] virtual FactorStatus factorise(const SparseMatrix& A,
                                                 const std::function<std::vector<double>()>& apart) = 0;
    /// x, near A^-1 b: linear and symmetric in b; b and x (rows) must not overlap.
    virtual void cycle(const double* b, double* x) = 0;
};

/// PETSc stays unloaded until the first call.
/// @throws RunFailure where the module cannot be loaded
[[nodiscard]] std::unique_ptr<Multigrid> make_multigrid(NodalUnknowns unknowns);

} // namespace osculate::solve
