#pragma once
/// Blocks that couple bodies, added up.

#include "multigrid/free_nodes.hpp"

#include <algorithm>
#include <vector>

namespace osculate::solve {

/// In rows of one's own free nodes, those with blocks alone. Many springs have the same masters, so that one block stands for several.
class Coupling {
public:
    Coupling() = default;
    Coupling(const FreeNodes& nodes, std::span<const NodalBlock> blocks);

    [[nodiscard]] Index rows() const { return static_cast<Index>(row_.size()); }
    [[nodiscard]] Index row(Index r) const { return row_[r]; } ///< ascending
    /// The first of these rows from node i on.
    [[nodiscard]] Index first_row_from(Index i) const {
        return static_cast<Index>(std::ranges::lower_bound(row_, i) - row_.begin());
    }
    [[nodiscard]] Index begin(Index r) const { return start_[r]; }
    [[nodiscard]] Index end(Index r) const { return start_[r + 1]; }
    [[nodiscard]] Index column(Index k) const { return column_[k]; }
    [[nodiscard]] const Mat3& block(Index k) const { return block_[k]; }

private:
    std::vector<Index> row_, start_{0}, column_;
    std::vector<Mat3> block_;
};

} // namespace osculate::solve
