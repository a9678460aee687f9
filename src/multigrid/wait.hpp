#pragma once
/// Waits for other processes that leave the processor to others after a while. MPI's own take all of it, for as long as another
/// process reads, writes or shares out nodes.

#include <mpi.h>
#include <span>

namespace osculate::solve {

/// Until messages have come and gone. For some milliseconds it asks without pause, as a processor that was idle wakes slowly.
void wait(std::span<MPI_Request> messages);

/// Until every process is here; what all do next finds nobody late.
void meet();

} // namespace osculate::solve
