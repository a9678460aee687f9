#pragma once
/// Sparse direct factorisation behind one interface.

#include "osculate/solve/sparse_matrix.hpp"

#include <memory>
#include <vector>

namespace osculate {
class Timings;
}

namespace osculate::solve {

enum class FactorStatus {
    ok,
    singular,   ///< a pivot is zero or negligible: something is held by nothing
    indefinite, ///< Cholesky met a negative pivot
};

class DirectSolver {
public:
    virtual ~DirectSolver() = default;
    /// Factorises A, analysing its pattern first when that is new. A must stay alive and unchanged until the last solve().
    [[nodiscard]] virtual FactorStatus factorise(const SparseMatrix& A) = 0;
    /// x = A^-1 b; b and x (rows) must not overlap.
    virtual void solve(const double* b, double* x) = 0;
    /// Equation of the smallest pivot, where the last factorisation failed; -1 unknown.
    [[nodiscard]] virtual SparseIndex failing_equation() const { return -1; }
};

/// Factors that hold the inverse of the matrix on some of its unknowns, too.
class CondensingSolver : public DirectSolver {
public:
    /// (A^-1)_kk over the kept unknowns k, in their order; both triangles. @pre factorise() returned ok
    [[nodiscard]] virtual Matrix compliance() = 0;
};

/// CHOLMOD supernodal LL^T with METIS ordering, for symmetric positive definite matrices.
[[nodiscard]] std::unique_ptr<DirectSolver> make_cholesky();
/// The same with the unknowns `kept` (equations, each once) eliminated last: their Schur complement stands in the last
/// columns of the factor, and its inverse costs no further solves.
[[nodiscard]] std::unique_ptr<CondensingSolver> make_condensing_cholesky(std::vector<SparseIndex> kept);
/// UMFPACK LU, symmetric strategy with METIS ordering, for everything else.
[[nodiscard]] std::unique_ptr<DirectSolver> make_lu();

} // namespace osculate::solve
