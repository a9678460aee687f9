#pragma once
/// What the summary says of the processes that share a run.

#include "osculate/equilibrium/equilibrium.hpp"
#include "osculate/output/summary.hpp"

#include <vector>

namespace osculate::app {

/// The most resident memory that this process has had so far, bytes.
[[nodiscard]] long peak_memory_bytes();

/// In the order of their ranks, with what they have throughout; none where one process runs alone.
[[nodiscard]] std::vector<output::Summary::Process> processes_of(const model::Model& model);

/// Puts in what they have by now: slave nodes and memory. Collective; nothing to do without processes.
void update_processes(std::vector<output::Summary::Process>& processes, const equilibrium::Equilibrium& equilibrium,
                      const model::Model& model);

} // namespace osculate::app
