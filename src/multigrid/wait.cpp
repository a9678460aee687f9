#include "multigrid/wait.hpp"

#include <algorithm>
#include <chrono>
#include <thread>

namespace osculate::solve {

void wait(std::span<MPI_Request> messages) {
    using Clock = std::chrono::steady_clock;
    using std::chrono::milliseconds;
    constexpr Clock::duration awake = milliseconds(5), longest = milliseconds(10);
    const auto begin = Clock::now();
    for (int done = 0;;) {
        MPI_Testall(static_cast<int>(messages.size()), messages.data(), &done, MPI_STATUSES_IGNORE);
        if (done != 0) return;
        const Clock::duration waited = Clock::now() - begin;
        if (waited > awake) std::this_thread::sleep_for(std::min(waited / 8, longest)); // little against the wait
    }
}

void meet() {
    MPI_Request all_here = MPI_REQUEST_NULL;
    MPI_Ibarrier(MPI_COMM_WORLD, &all_here);
    wait({&all_here, 1});
}

} // namespace osculate::solve
