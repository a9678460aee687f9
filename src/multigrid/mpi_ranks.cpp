#include "multigrid/exchange.hpp"
#include "multigrid/petsc_check.hpp"
#include "osculate/core/ranks.hpp"

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <numeric>
#include <thread>

namespace osculate::solve {
namespace {

class MpiRanks final : public Ranks {
public:
    MpiRanks() {
        begin_petsc();
        MPI_Comm_rank(MPI_COMM_WORLD, &rank_);
        MPI_Comm_size(MPI_COMM_WORLD, &count_);
        MPI_Comm_dup(MPI_COMM_WORLD, &at_the_end_);
        // GAMG's own products, in bits that do not depend on which message comes first
        check(PetscOptionsSetValue(nullptr, "-matptap_via", "backend"));
    }
    ~MpiRanks() override {
        MPI_Comm_free(&at_the_end_);
        PetscFinalize();
    }
    MpiRanks(const MpiRanks&) = delete;
    MpiRanks& operator=(const MpiRanks&) = delete;

    [[nodiscard]] int rank() const override { return rank_; }
    [[nodiscard]] int count() const override { return count_; }
    void gather(std::span<const double> own, std::span<const int> sizes, double* all) override {
        std::vector<int> begin(sizes.size(), 0);
        std::partial_sum(sizes.begin(), sizes.end() - 1, begin.begin() + 1);
        if (count_ <= few) {
            give_to_each(own, sizes, begin, all);
        } else {
            meet();
            MPI_Allgatherv(own.data(), static_cast<int>(own.size()), MPI_DOUBLE, all, sizes.data(), begin.data(),
                           MPI_DOUBLE, MPI_COMM_WORLD);
        }
    }

    void exchange(const std::vector<std::vector<double>>& out, std::vector<std::vector<double>>& in) override {
        send_and_receive(out, in);
    }

    [[nodiscard]] bool agree_on_end(int code, double patience) override {
        std::vector<int> all(static_cast<std::size_t>(count_));
        MPI_Request request = MPI_REQUEST_NULL;
        MPI_Iallgather(&code, 1, MPI_INT, all.data(), 1, MPI_INT, at_the_end_, &request);
        constexpr std::chrono::milliseconds pause(10);
        const auto until = std::chrono::steady_clock::now() + std::chrono::duration<double>(patience);
        for (int done = 0; done == 0; std::this_thread::sleep_for(pause)) {
            MPI_Test(&request, &done, MPI_STATUS_IGNORE);
            if (done == 0 && std::chrono::steady_clock::now() > until) return false;
        }
        return std::ranges::all_of(all, [&](int other) { return other == code; });
    }
    [[noreturn]] void abort(int code) override {
        MPI_Abort(MPI_COMM_WORLD, code);
        std::abort();
    }

private:
    /// Processes that a message to each reaches sooner than MPI's stages after a meeting.
    static constexpr int few = 16;

    void give_to_each(std::span<const double> own, std::span<const int> sizes, const std::vector<int>& begin,
                      double* all) const {
        constexpr int tag = 27;
        std::vector<MPI_Request> open;
        const auto others = [&](auto&& each) {
            for (int r = 0; r < count_; ++r)
                if (r != rank_) each(r, static_cast<std::size_t>(r));
        };
        others([&](int r, std::size_t at) {
            if (sizes[at] > 0)
                MPI_Irecv(all + begin[at], sizes[at], MPI_DOUBLE, r, tag, MPI_COMM_WORLD, &open.emplace_back());
        });
        others([&](int r, std::size_t) {
            if (!own.empty())
                MPI_Isend(own.data(), static_cast<int>(own.size()), MPI_DOUBLE, r, tag, MPI_COMM_WORLD,
                          &open.emplace_back());
        });
        std::ranges::copy(own, all + begin[static_cast<std::size_t>(rank_)]);
        wait(open);
    }

    int rank_ = 0, count_ = 1;
    MPI_Comm at_the_end_ = MPI_COMM_NULL;
};

} // namespace
} // namespace osculate::solve

extern "C" osculate::Ranks* osculate_join_ranks() {
    return new osculate::solve::MpiRanks;
}
