#pragma once
/// Ranks that are threads of the test.

#include "osculate/core/ranks.hpp"

#include <algorithm>
#include <barrier>
#include <functional>
#include <stdexcept>
#include <thread>

namespace osculate::support {

/// Calls body(ranks) on `count` threads that are processes to each other.
inline void on_ranks(int count, const std::function<void(std::shared_ptr<Ranks>)>& body) {
    struct Shared {
        explicit Shared(int n) : all_here(n), own(static_cast<std::size_t>(n)), out(own.size()) {}
        std::barrier<> all_here;
        std::vector<std::vector<double>> own;
        std::vector<const std::vector<std::vector<double>>*> out;
    };
    class ThreadRank final : public Ranks {
    public:
        ThreadRank(Shared& shared, int rank, int count) : shared_(shared), rank_(rank), count_(count) {}
        [[nodiscard]] int rank() const override { return rank_; }
        [[nodiscard]] int count() const override { return count_; }
        void gather(std::span<const double> own, std::span<const int>, double* all) override {
            shared_.own[static_cast<std::size_t>(rank_)].assign(own.begin(), own.end());
            shared_.all_here.arrive_and_wait();
            for (const std::vector<double>& one : shared_.own) all = std::ranges::copy(one, all).out;
            shared_.all_here.arrive_and_wait();
        }
        void exchange(const std::vector<std::vector<double>>& out, std::vector<std::vector<double>>& in) override {
            shared_.out[static_cast<std::size_t>(rank_)] = &out;
            shared_.all_here.arrive_and_wait();
            for (std::size_t r = 0; r < in.size(); ++r) {
                const std::vector<double>& from = (*shared_.out[r])[static_cast<std::size_t>(rank_)];
                if (from.size() != in[r].size()) throw std::logic_error("another length comes than is expected");
                in[r] = from;
            }
            shared_.all_here.arrive_and_wait();
        }
        [[nodiscard]] bool agree_on_end(int, double) override { return true; }
        [[noreturn]] void abort(int) override { throw std::logic_error("aborted"); }

    private:
        Shared& shared_;
        int rank_, count_;
    };
    Shared shared(count);
    std::vector<std::thread> threads;
    for (int rank = 0; rank < count; ++rank)
        threads.emplace_back([&, rank] { body(std::make_shared<ThreadRank>(shared, rank, count)); });
    for (std::thread& thread : threads) thread.join();
}

} // namespace osculate::support
