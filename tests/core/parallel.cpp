#include "osculate/core/parallel.hpp"

#include <atomic>
#include <cfenv>
#include <cmath>
#include <gtest/gtest.h>
#include <stdexcept>
#include <string>
#include <thread>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

TEST(ParallelFor, VisitsEveryItemOnce) {
    for (const int threads : {-1, 0, 1, 2, 3, 8, 64})
        for (const Index n : {0, 1, 31, 32, 33, 64, 65, 1000, 4097}) {
            std::vector<std::atomic<int>> visits(static_cast<std::size_t>(n));
            parallel_for(threads, n, [&](Index begin, Index end) {
                for (Index i = begin; i < end; ++i) ++visits[i];
            });
            for (Index i = 0; i < n; ++i) ASSERT_EQ(visits[i], 1) << "item " << i << " of " << n << ", " << threads;
        }
}

TEST(ParallelFor, GivesTheSameBitsForAnyNumberOfThreads) {
    const Index n = 5000;
    const auto run = [&](int threads) {
        std::vector<double> result(n);
        parallel_for(threads, n, [&](Index begin, Index end) {
            for (Index i = begin; i < end; ++i) result[i] = std::sin(0.1 * i) / (1 + i);
        });
        return result;
    };
    const std::vector<double> one = run(1);
    for (const int threads : {2, 3, 7}) EXPECT_EQ(run(threads), one);
}

TEST(ParallelFor, UsesTheThreadsItIsGivenAndNoMore) {
    for (const int threads : {1, 2, 5}) {
        std::atomic<int> chunks = 0;
        parallel_for(threads, 10000, [&](Index, Index) { ++chunks; });
        EXPECT_EQ(chunks, threads);
    }
}

TEST(ParallelFor, RethrowsTheFirstChunksExceptionAfterAllHaveEnded) {
    for (const int threads : {1, 4}) {
        std::atomic<Index> done = 0;
        try {
            parallel_for(threads, 4000, [&](Index begin, Index end) {
                done += end - begin;
                throw std::runtime_error("chunk from " + std::to_string(begin));
            });
            FAIL() << "nothing thrown";
        } catch (const std::runtime_error& error) {
            EXPECT_STREQ(error.what(), "chunk from 0");
        }
        EXPECT_EQ(done, 4000);
    }
}

TEST(ParallelFor, RunsWithinItselfOneAfterAnother) {
    std::vector<std::atomic<int>> visits(64 * 64);
    parallel_for(2, 64, [&](Index begin, Index end) {
        for (Index i = begin; i < end; ++i)
            parallel_for(2, 64, [&](Index from, Index to) {
                for (Index k = from; k < to; ++k) ++visits[64 * i + k];
            });
    });
    for (const auto& count : visits) ASSERT_EQ(count, 1);
}

TEST(ParallelFor, ServesSeveralCallersAtOnce) {
    std::vector<std::atomic<int>> visits(1000);
    const auto visit_all = [&] {
        for (int k = 0; k < 50; ++k)
            parallel_for(3, 1000, [&](Index begin, Index end) {
                for (Index i = begin; i < end; ++i) ++visits[i];
            });
    };
    {
        const std::jthread other(visit_all);
        visit_all();
    }
    for (const auto& count : visits) ASSERT_EQ(count, 100);
}

TEST(ParallelFor, KeepsTheFloatingPointEnvironmentOfItsCaller) {
    for (const int rounding : {FE_UPWARD, FE_TONEAREST}) { // the same threads, another environment
        std::fesetround(rounding);
        std::atomic<int> others = 0;
        parallel_for(3, 1000, [&](Index, Index) { others += std::fegetround() != rounding; });
        EXPECT_EQ(others, 0);
    }
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
