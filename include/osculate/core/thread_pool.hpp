#pragma once
/// Threads that wait for work, so that sharing is worthwhile even for a loop of a tenth of a millisecond.

#include "osculate/core/types.hpp"

#include <functional>

namespace osculate {

/// Calls task(i) for i in [0, count): task 0 on the calling thread, each other task on a thread of its own, with the
/// caller's floating-point environment. Returns when all have ended. Threads are started when first needed and live as
/// long as the process. Calls from within a task, and calls while the threads work for another caller, run their tasks
/// one after another.
/// @pre task throws nothing
void run_side_by_side(Index count, const std::function<void(Index)>& task);

} // namespace osculate
