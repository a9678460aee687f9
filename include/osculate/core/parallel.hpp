#pragma once
/// Loops over independent items on several threads.

#include "osculate/core/thread_pool.hpp"
#include "osculate/core/types.hpp"

#include <algorithm>
#include <exception>
#include <vector>

namespace osculate {

/// Calls body(begin, end) on contiguous chunks of [0, n). Every item must write only its own results: then the result
/// is bitwise the same for any number of threads. After all chunks have ended, rethrows the exception of the first
/// chunk that threw.
template <class Body> void parallel_for(int threads, Index n, Body&& body) {
    const Index smallest_chunk = 32; // below this a thread costs more than it saves
    const Index chunks = std::clamp<Index>(n / smallest_chunk, 1, std::max(threads, 1));
    if (chunks == 1) {
        body(Index{0}, n);
        return;
    }
    std::vector<std::exception_ptr> errors(static_cast<std::size_t>(chunks));
    run_side_by_side(chunks, [&](Index chunk) {
        try {
            body(static_cast<Index>(std::int64_t{n} * chunk / chunks),
                 static_cast<Index>(std::int64_t{n} * (chunk + 1) / chunks));
        } catch (...) {
            errors[static_cast<std::size_t>(chunk)] = std::current_exception();
        }
    });
    for (const std::exception_ptr& error : errors)
        if (error) std::rethrow_exception(error);
}

/// One of several passes over the same items; each pass writes only the results that it owns.
struct Lane {
    Index index = 0, count = 1;
    [[nodiscard]] bool owns(Index owner) const { return owner % count == index; }
};

/// Calls body(lane) for every lane, each on its own thread. Each result has one owner, which writes it in the order of
/// the items, so that sums are bitwise the same for any number of threads.
template <class Body> void parallel_lanes(int threads, Body&& body) {
    const Index lanes = std::max(threads, 1);
    if (lanes == 1) return body(Lane{});
    std::vector<std::exception_ptr> errors(static_cast<std::size_t>(lanes));
    run_side_by_side(lanes, [&](Index lane) {
        try {
            body(Lane{lane, lanes});
        } catch (...) {
            errors[static_cast<std::size_t>(lane)] = std::current_exception();
        }
    });
    for (const std::exception_ptr& error : errors)
        if (error) std::rethrow_exception(error);
}

} // namespace osculate
