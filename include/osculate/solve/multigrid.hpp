#pragma once
/// Algebraic multigrid for the stiffness of elastic bodies.

#include "osculate/solve/direct_solver.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace osculate::solve {

/// What multigrid needs to know of a matrix besides its entries.
struct NodalUnknowns {
    std::vector<SparseIndex> equation; ///< (3 nodes) of each component, ascending; -1: held, at most two per node
    Matrix near_kernel;                ///< (3 nodes x 6) motions without strain, body by body in the same columns
};

/// V-cycles of smoothed aggregation, PETSc's GAMG. Grids are built once from matrices of uncoupled bodies, so that no
/// coarse unknown joins two bodies; the coupling enters only the coarse matrices.
class Multigrid {
public:
    virtual ~Multigrid() = default;
    /// @param A      symmetric positive definite; must stay alive and unchanged until the last cycle()
    /// @param apart  called when the pattern of A is new, for the values (nonzeros of A) from which grids are built:
    ///               without the coupling of bodies, and the same at every call, so that a solution does not depend on
    ///               the time of the call
    [[nodiscard]] virtual FactorStatus factorise(const SparseMatrix& A,
                                                 const std::function<std::vector<double>()>& apart) = 0;
    /// x approximates A^-1 b: linear and symmetric in b; b and x (rows) must not overlap.
    virtual void cycle(const double* b, double* x) = 0;
};

/// Loads PETSc at the first call.
/// @throws RunFailure if the module cannot be loaded
[[nodiscard]] std::unique_ptr<Multigrid> make_multigrid(NodalUnknowns unknowns);

} // namespace osculate::solve
