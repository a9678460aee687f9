#pragma once
/// The matrix of the finest grid and its smoother's preconditioner.

#include "multigrid/free_nodes.hpp"

#include <algorithm>
#include <vector>

namespace osculate::solve {

/// Smoothing waits for memory: blocks in single precision take 40 bytes where rows in double precision take 84. Vectors are in
/// double precision, and so are sums; a cycle errs by 1e-7 of itself, which GMRES does not see. The coupling of bodies is kept
/// in double precision beside them. Held directions have a diagonal alone.
class FineGrid {
public:
    /// @param nodes  must outlive this object
    FineGrid(const FreeNodes& nodes, const NodalMatrix& bodies);
    /// Takes the values of the bodies.
    void take(const NodalMatrix& bodies);
    void couple(std::span<const NodalBlock> coupling);
    /// y = A x over (3 n) global components
    void multiply(const double* x, double* y) const;
    /// y = D^-1 x, where D is the block diagonal of A
    void scale(const double* x, double* y) const;
    /// Estimate of the largest eigenvalue of D^-1 A: that of the bodies alone, or of coupled nodes and their neighbours.
    [[nodiscard]] double largest_eigenvalue() const { return std::max(largest_of_bodies_, largest_of_coupled_); }

    [[nodiscard]] Index size() const { return nodes_.size(); }
    [[nodiscard]] const Mat3& inverse_diagonal(Index i) const { return inverse_[i]; }

private:
    /// y = A x at nodes of a list, of the bodies alone
    void multiply_rows(std::span<const Index> rows, const double* x, double* y) const;
    void add_coupling(const double* x, double* y) const;
    /// Of the rows and columns of some nodes.
    [[nodiscard]] double estimate(std::span<const Index> rows) const;

    const FreeNodes& nodes_;
    double largest_of_bodies_ = 0, largest_of_coupled_ = 0;
    std::vector<Index> start_, node_; ///< (n + 1) of blocks, (blocks) column
    std::vector<float> value_;        ///< (9 blocks, and one) by columns
    std::vector<Mat3> diagonal_;      ///< (n) D_K
    std::vector<Mat3> inverse_;       ///< (n) D^-1, D of the sum
    std::vector<NodalBlock> coupling_;
};

} // namespace osculate::solve
