#pragma once
/// Groups of neighbouring nodes, one for each node of the next grid.

#include "multigrid/free_nodes.hpp"

namespace osculate::solve {

struct Aggregates {
    std::vector<Index> of; ///< (n) the aggregate of each of one's own free nodes
    Index count = 0;
};

/// Of one's own nodes. Every node whose neighbours are all left makes an aggregate with them; nodes that remain join the neighbour to which they
/// are tied most stiffly (Vanek, Mandel and Brezina 1996).
[[nodiscard]] Aggregates aggregate(const FreeNodes& nodes, const NodalMatrix& A);

} // namespace osculate::solve
