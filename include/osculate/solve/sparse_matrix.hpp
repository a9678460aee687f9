#pragma once
/// Square sparse matrix with a fixed pattern; values are rewritten in place.

#include "osculate/core/types.hpp"

#include <cstdint>
#include <vector>

namespace osculate::solve {

using SparseIndex = std::int64_t; ///< SuiteSparse_long

/// Compressed rows, columns ascending within a row, both triangles stored even if the matrix is symmetric. `pattern`
/// changes whenever the pattern does and `revision` whenever the values do, so that solvers know what they can keep.
struct SparseMatrix {
    std::vector<SparseIndex> row_start{0}; ///< (rows + 1)
    std::vector<SparseIndex> column;       ///< (nonzeros)
    std::vector<double> value;             ///< (nonzeros)
    bool symmetric_positive_definite = false;
    bool may_turn_indefinite = false; ///< positive definite only as long as nothing buckles
    std::uint64_t pattern = 0;
    std::uint64_t revision = 0;

    [[nodiscard]] SparseIndex rows() const { return static_cast<SparseIndex>(row_start.size()) - 1; }
    [[nodiscard]] SparseIndex nonzeros() const { return static_cast<SparseIndex>(column.size()); }
    /// y = A x
    void multiply(const double* x, double* y) const;
};

} // namespace osculate::solve
