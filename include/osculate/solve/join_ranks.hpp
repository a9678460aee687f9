#pragma once
/// The processes of an MPI run.

#include "osculate/core/lists.hpp"
#include "osculate/core/ranks.hpp"

namespace osculate::solve {

/// Loads MPI and joins the processes that were started together; one process alone is a run of one. To be called once; MPI ends
/// with the object.
/// @throws RunFailure if the module cannot be loaded
[[nodiscard]] std::shared_ptr<Ranks> join_ranks();

/// Shares nodes out, so that processes have about as many neighbourhoods each and few neighbours of other processes, by METIS;
/// the same on all processes.
/// @param neighbours  of each node, itself included
/// @param together    pairs of nodes that go to the same rank
/// @returns           (nodes) a rank
[[nodiscard]] std::vector<int> share_nodes(const Lists& neighbours, int ranks,
                                           std::span<const std::pair<Index, Index>> together = {});

} // namespace osculate::solve
