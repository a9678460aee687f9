#pragma once
/// From six motions of each aggregate to displacements of nodes.

#include "multigrid/aggregates.hpp"
#include "multigrid/copied_rows.hpp"
#include "multigrid/fine_grid.hpp"

namespace osculate::solve {

/// P = (I - w D^-1 A) P_0, where P_0 moves each aggregate by motions without strain (orthonormal columns) and w = 4/3 over the
/// largest eigenvalue of D^-1 A. In single precision: a coarse matrix is exact for the P it is made with.
class Prolongation {
public:
    static constexpr Index modes = 6; ///< of an aggregate
    using Block = Eigen::Matrix<double, 3, modes, Eigen::RowMajor>;

    /// @param A  of the undeformed bodies, held in `grid` too
    Prolongation(const FreeNodes& nodes, const NodalMatrix& A, const FineGrid& grid, const NodalUnknowns& unknowns,
                 int threads);

    /// One's own aggregates, and with those of other processes that rows here reach, which come after them.
    [[nodiscard]] Index aggregates() const { return aggregates_; }
    [[nodiscard]] Index with_copies() const { return static_cast<Index>(number_.size()); }
    /// Number of an aggregate among all of all processes; one's own are consecutive.
    [[nodiscard]] Index number(Index aggregate) const { return number_[aggregate]; }
    [[nodiscard]] Index first_number() const { return first_number_; }
    /// (6 aggregates of all processes x 6) of the motions without strain
    [[nodiscard]] const Matrix& near_kernel() const { return near_kernel_; }
    /// (aggregates of all processes)
    [[nodiscard]] const std::vector<Index>& body() const { return body_; }
    [[nodiscard]] const Exchange& exchange() const { return exchange_; }
    [[nodiscard]] Index row_begin(Index i) const { return start_[i]; }
    [[nodiscard]] Index row_end(Index i) const { return start_[i + 1]; }
    [[nodiscard]] Index aggregate(Index entry) const { return aggregate_[entry]; }
    /// A block of node i, one's own or a copy, zero along its held directions.
    [[nodiscard]] Block block(Index i, Index entry) const {
        const Block value =
            Eigen::Map<const Stored>(value_.data() + stored * static_cast<std::size_t>(entry)).cast<double>();
        return nodes_.whole(i) ? value : Block(nodes_.projection(i) * value);
    }
    /// x += P c at one's own nodes, in global components; fills the copies in c.
    void add_to_fine(double* c, double* x) const;
    /// c = P^T x from one's own nodes, for one's own aggregates; c has room for the copies.
    void to_coarse(const double* x, double* c) const;

private:
    using Stored = Eigen::Matrix<float, 3, modes, Eigen::RowMajor>;
    static constexpr std::size_t stored = 18;

    using Rows = InterpolationRows<Stored>; ///< of nodes

    /// Motions of aggregates of all processes, from one's own.
    void gather_motions(const Matrix& own, const std::vector<Index>& body);
    void store(const Rows& rows, const std::vector<Index>& first_of_rank);

    const FreeNodes& nodes_;
    int threads_;
    Index aggregates_ = 0, first_number_ = 0;
    std::vector<Index> number_, body_;
    Matrix near_kernel_;
    Exchange exchange_;                       ///< of aggregates
    std::vector<Index> start_{0}, aggregate_; ///< of one's own nodes and of copies
    std::vector<float> value_;                ///< (18 entries)
};

} // namespace osculate::solve
