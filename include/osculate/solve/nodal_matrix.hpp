#pragma once
/// Matrices of 3 x 3 blocks over the nodes of all bodies, in global components, as solvers see them.

#include "osculate/core/types.hpp"

#include <span>

namespace osculate::solve {

/// A view of a matrix in compressed block rows.
struct NodalMatrix {
    std::span<const Index> row_start, column; ///< (nodes + 1), (blocks) ascending in a row
    std::span<const Mat3> block;
};

/// One block to be added.
struct NodalBlock {
    Index row = -1, column = -1; ///< nodes
    Mat3 value = Mat3::Zero();
};

} // namespace osculate::solve
