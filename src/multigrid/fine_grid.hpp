#pragma once
/// The matrix of the finest grid and its smoother's preconditioner.

#include "multigrid/coupling.hpp"

#include <algorithm>
#include <vector>

namespace osculate::solve {

/// Smoothing waits for memory: blocks in single precision take 40 bytes where rows in double precision take 84. Vectors are in
/// double precision, and so are sums; a cycle errs by 1e-7 of itself, which GMRES does not see. The coupling of bodies is kept
/// in double precision beside them. Held directions have a diagonal alone.
class FineGrid {
public:
    /// @param nodes  must outlive this object
    FineGrid(const FreeNodes& nodes, const NodalMatrix& bodies, int threads);
    /// Takes the values of the bodies.
    void take(const NodalMatrix& bodies);
    void couple(Coupling coupling);
    /// r = b - A x in global components, at one's own nodes; fills the copies in x, as the next do
    void residual(const double* b, double* x, double* r) const;
    /// One sweep of a smoother, with one reading of A: to = x + momentum (x - before) + step D^-1 (b - A x), where D is the
    /// block diagonal of A.
    /// @param before  may be `to`; null: zeros
    void sweep(const double* b, double* x, const double* before, double momentum, double step, double* to) const;
    /// The first sweep from zero: to = step D^-1 b
    void first_sweep(const double* b, double step, double* to) const;
    /// Estimate of the largest eigenvalue of D^-1 A: that of the bodies alone, or of coupled nodes and their neighbours.
    [[nodiscard]] double largest_eigenvalue() const { return std::max(largest_of_bodies_, largest_of_coupled_); }

    [[nodiscard]] const Mat3& inverse_diagonal(Index i) const { return inverse_[i]; }

private:
    /// Calls each(i, (A x)_i) for all rows, on several threads; fills the copies in x.
    template <class Each> void for_rows(double* x, Each&& each) const;
    /// Of the rows and columns of some nodes, ascending.
    [[nodiscard]] double estimate(std::span<const Index> rows) const;

    const FreeNodes& nodes_;
    int threads_;
    double largest_of_bodies_ = 0, largest_of_coupled_ = 0;
    std::vector<Index> start_, node_; ///< (n + 1) of blocks, (blocks) column
    std::vector<float> value_;        ///< (9 blocks, and one) by columns
    std::vector<Mat3> diagonal_;      ///< (n) D_K
    std::vector<Mat3> inverse_;       ///< (n) D^-1, D of the sum, at one's own nodes
    Coupling coupling_;
};

} // namespace osculate::solve
