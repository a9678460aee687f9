#pragma once
/// P^T A P two grids below the finest, where several processes share it.

#include "multigrid/block_rows.hpp"

#include <petscmat.h>

namespace osculate::solve {

/// What PETSc's interpolation does with rows of A: its blocks here, and those of copied rows.
class AggregateInterpolation {
public:
    using Block = BlockRows::Square;

    /// @param P  PETSc's, to the aggregates of A
    AggregateInterpolation(Mat P, const BlockRows& A);

    /// As in Prolongation.
    [[nodiscard]] Index aggregates() const { return aggregates_; }
    [[nodiscard]] Index first_number() const { return first_number_; }
    [[nodiscard]] Index with_copies() const { return static_cast<Index>(number_.size()); }
    [[nodiscard]] Index number(Index aggregate) const { return number_[aggregate]; }
    [[nodiscard]] Index row_begin(Index i) const { return start_[i]; }
    [[nodiscard]] Index row_end(Index i) const { return start_[i + 1]; }
    [[nodiscard]] Index aggregate(Index entry) const { return aggregate_[entry]; }
    [[nodiscard]] const Block& block(Index, Index entry) const { return block_[entry]; }
    [[nodiscard]] const Exchange& exchange() const { return exchange_; }
    /// Row here of each block that A has in columns of other processes.
    [[nodiscard]] const std::vector<Index>& row_of_others() const { return row_of_others_; }

private:
    Index aggregates_ = 0, first_number_ = 0;
    std::vector<Index> number_, start_{0}, aggregate_;
    std::vector<Block> block_;
    Exchange exchange_;
    std::vector<Index> row_of_others_;
};

/// Each process multiplies its rows of A, block by block. PETSc's own product adds up what comes from others as it comes, with
/// other bits each time, or keeps A P, P^T, and copies of rows of A and P.
class ThirdMatrix {
public:
    /// @param A  must outlive this object
    ThirdMatrix(Mat P, const BlockRows& A, const BlockRows::Values& values, int threads);
    ThirdMatrix(const ThirdMatrix&) = delete;
    ThirdMatrix& operator=(const ThirdMatrix&) = delete;
    /// Takes other values of A.
    void take(const BlockRows::Values& A);

    [[nodiscard]] BlockRows& rows() { return rows_; }
    [[nodiscard]] BlockRows::Values& values() { return values_; }

private:
    const BlockRows& A_;
    int threads_;
    AggregateInterpolation P_;
    BlockRows rows_;
    BlockRows::Values values_;
};

} // namespace osculate::solve
