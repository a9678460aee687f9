#pragma once
/// From six motions of each aggregate to displacements of nodes.

#include "multigrid/aggregates.hpp"
#include "multigrid/fine_grid.hpp"

namespace osculate::solve {

/// P = (I - w D^-1 A) P_0, where P_0 moves each aggregate by motions without strain (orthonormal columns) and w = 4/3 over the
/// largest eigenvalue of D^-1 A. In single precision: a coarse matrix is exact for the P it is made with.
class Prolongation {
public:
    static constexpr Index modes = 6; ///< of an aggregate
    using Block = Eigen::Matrix<double, 3, modes, Eigen::RowMajor>;

    /// @param A            of the undeformed bodies, held in `grid` too
    /// @param near_kernel  (3 n x 6)
    Prolongation(const FreeNodes& nodes, const NodalMatrix& A, const FineGrid& grid, const Matrix& near_kernel);

    [[nodiscard]] Index aggregates() const { return aggregates_; }
    /// (6 aggregates x 6) of the motions without strain
    [[nodiscard]] const Matrix& near_kernel() const { return near_kernel_; }
    [[nodiscard]] Index row_begin(Index i) const { return start_[i]; }
    [[nodiscard]] Index row_end(Index i) const { return start_[i + 1]; }
    [[nodiscard]] Index aggregate(Index entry) const { return aggregate_[entry]; }
    /// A block of node i, zero along its held directions.
    [[nodiscard]] Block block(Index i, Index entry) const {
        const Block value =
            Eigen::Map<const Stored>(value_.data() + stored * static_cast<std::size_t>(entry)).cast<double>();
        return nodes_.whole(i) ? value : Block(nodes_.projection(i) * value);
    }
    /// x += P c, x (3 n) in global components
    void add_to_fine(const double* c, double* x) const;
    /// c = P^T x
    void to_coarse(const double* x, double* c) const;

private:
    using Stored = Eigen::Matrix<float, 3, modes, Eigen::RowMajor>;
    static constexpr std::size_t stored = 18;

    const FreeNodes& nodes_;
    Index aggregates_ = 0;
    Matrix near_kernel_;
    std::vector<Index> start_{0}, aggregate_; ///< ascending in a row
    std::vector<float> value_;                ///< (18 entries)
};

} // namespace osculate::solve
