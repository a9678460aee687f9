#pragma once
/// Matrices whose rows processes share, as a whole.

#include "osculate/linear/block_matrix.hpp"

namespace osculate::linear {

/// All rows of a matrix on every process: the same matrix, bit for bit, as one process would have of these rows. Collective.
/// @pre  matrix.share() != nullptr
[[nodiscard]] BlockMatrix gathered(const BlockMatrix& matrix);

} // namespace osculate::linear
