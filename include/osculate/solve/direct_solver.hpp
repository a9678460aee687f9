#pragma once
/// Sparse direct factorisation with one interface.

#include "osculate/solve/sparse_matrix.hpp"

#include <memory>
#include <span>
#include <vector>

namespace osculate {
class Timings;
}

namespace osculate::solve {

enum class FactorStatus {
    ok,
    singular,   ///< a pivot is zero or negligible: some motion is not held
    indefinite, ///< Cholesky found a negative pivot
};

class DirectSolver {
public:
    virtual ~DirectSolver() = default;
    /// Factorises A, after analysis of its pattern if this is new. A must stay alive and unchanged until the last
    /// solve().
    [[nodiscard]] virtual FactorStatus factorise(const SparseMatrix& A) = 0;
    /// x = A^-1 b; b and x (rows) must not overlap.
    virtual void solve(const double* b, double* x) = 0;
    /// The same for several right sides: X = A^-1 B, both (rows x columns), which must not overlap.
    virtual void solve(const Matrix& B, Matrix& X) {
        X.resize(B.rows(), B.cols());
        for (Index c = 0; c < B.cols(); ++c) solve(B.col(c).data(), X.col(c).data());
    }
    /// Equation of the smallest pivot, if the last factorisation failed; -1: unknown.
    [[nodiscard]] virtual SparseIndex failing_equation() const { return -1; }
};

/// Factorisation that also gives the inverse of the matrix on some of its unknowns, as a matrix or as a product.
class CondensingSolver : public DirectSolver {
public:
    /// Chooses the equations, each once, of solve_selected(); the choice holds until the next. @pre factorise() returned ok
    virtual void select(std::span<const SparseIndex> equations) = 0;
    /// x = (A^-1 b) at the chosen equations for a b that is zero elsewhere; both in the order of the choice, and perhaps the same
    /// array. In single precision, about twice as quick as solve(): for use within iterations that check their result.
    virtual void solve_selected(const double* b, double* x) = 0;
    /// Estimate of the time of factorise() over that of one solution.
    [[nodiscard]] virtual double effort() const = 0;
    /// (A^-1)_kk over the kept unknowns k, in their order; both triangles. @pre factorise() returned ok
    [[nodiscard]] virtual Matrix compliance() = 0;
};

/// CHOLMOD supernodal LL^T with METIS ordering, for symmetric positive definite matrices.
[[nodiscard]] std::unique_ptr<DirectSolver> make_cholesky();
/// The same, but eliminates the unknowns `kept` (equations, each once) last: the last columns of the factor contain
/// their Schur complement, whose inverse needs no further solves.
[[nodiscard]] std::unique_ptr<CondensingSolver> make_condensing_cholesky(std::vector<SparseIndex> kept);
/// UMFPACK LU, symmetric strategy with METIS ordering, for all other matrices.
[[nodiscard]] std::unique_ptr<DirectSolver> make_lu();

} // namespace osculate::solve
