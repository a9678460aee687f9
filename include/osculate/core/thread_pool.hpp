#pragma once
/// Threads that wait for work, so that a loop of a tenth of a millisecond is worth sharing.

#include "osculate/core/types.hpp"

#include <functional>

namespace osculate {

/// Calls task(i) for i in [0, count), task 0 on the calling thread, the others on one thread each, with the caller's
/// floating-point environment; returns when all have ended. Threads are started when first needed and live as long as the
/// process. Calls from within a task, and those that find the threads at work for another caller, run one task after another.
/// @pre task throws nothing
void run_side_by_side(Index count, const std::function<void(Index)>& task);

} // namespace osculate
