/// Replicas: equal pages of arrays, kept once.
#include "osculate/core/shared_pages.hpp"

#include "support/thread_ranks.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <memory>
#include <numeric>
#include <string>

namespace osculate {
namespace {

constexpr std::size_t numbers = 1 << 20; // of an array: 8 MB
constexpr double array_bytes = numbers * sizeof(double);
constexpr int count = 3;
constexpr std::size_t page = Replicas::page / sizeof(double);

/// Physical memory of this process, pages shared counted once, bytes.
double memory() {
    std::ifstream file("/proc/self/smaps_rollup");
    std::string word;
    while (file >> word)
        if (word == "Pss:") {
            double kilobytes = 0;
            file >> kilobytes;
            return 1024 * kilobytes;
        }
    return 0;
}

/// Numbers that begin at a page, as large arrays of processes do.
class Array {
public:
    Array() : first_(static_cast<double*>(std::aligned_alloc(Replicas::page, numbers * sizeof(double)))) {
        std::iota(begin(), end(), 0.5);
    }
    [[nodiscard]] double* begin() const { return first_.get(); }
    [[nodiscard]] double* end() const { return begin() + numbers; }
    [[nodiscard]] double& operator[](std::size_t k) const { return begin()[k]; }
    [[nodiscard]] bool operator==(const Array& other) const { return std::equal(begin(), end(), other.begin()); }
    void keep_once(Ranks& ranks) const {
        Replicas replicas;
        replicas.add(std::as_bytes(std::span(begin(), numbers)));
        replicas.keep_once(ranks);
    }

private:
    struct Free {
        void operator()(double* first) const { std::free(first); }
    };
    std::unique_ptr<double, Free> first_;
};

using Change = std::function<void(Array&, Ranks&)>;

/// Memory, bytes, that all give back by calling change(rank's array).
double saved(const Change& before, const Change& change) {
    double first = 0, last = 0;
    support::on_ranks(count, [&](const std::shared_ptr<Ranks>& ranks) {
        Array array;
        before(array, *ranks);
        const auto note = [&](double& value) {
            (void)ranks->largest(0);
            if (ranks->rank() == 0) value = memory();
            (void)ranks->largest(0);
        };
        note(first);
        change(array, *ranks);
        note(last);
    });
    return first - last;
}
void nothing(Array&, Ranks&) {}
void keep_once(Array& array, Ranks& ranks) {
    array.keep_once(ranks);
    EXPECT_GT(*std::ranges::max_element(array), numbers - 1); // read again
}

constexpr double precision = 0.1 * array_bytes; // scratch of messages, and pages that are not whole

TEST(Replicas, TakeTheMemoryOfOne) {
    EXPECT_NEAR(saved(nothing, keep_once), (count - 1) * array_bytes, precision);
}

TEST(Replicas, TakeNoMoreAfterTheyWereWrittenAndKeptAgain) {
    const auto write = [](Array& array, Ranks& ranks) {
        array.keep_once(ranks);
        for (double& value : array) value += 1;
    };
    EXPECT_NEAR(saved(write, keep_once), (count - 1) * array_bytes, precision);
}

TEST(Replicas, KeepTheirNumbers) {
    support::on_ranks(count, [](const std::shared_ptr<Ranks>& ranks) {
        const Array array, expected;
        array.keep_once(*ranks);
        EXPECT_EQ(array, expected);
    });
}

TEST(Replicas, AreOnesOwnWhereTheyAreWritten) {
    support::on_ranks(count, [](const std::shared_ptr<Ranks>& ranks) {
        const Array array, expected;
        array.keep_once(*ranks);
        const auto place = page * static_cast<std::size_t>(10 + ranks->rank());
        array[place] = expected[place] = -ranks->rank() - 1;
        (void)ranks->largest(0);
        EXPECT_EQ(array, expected);
        (void)ranks->largest(0);
    });
}

/// Pages that differ stay as they are, even by a bit that compares as equal.
TEST(Replicas, AreOnlyWhatHasTheSameBits) {
    support::on_ranks(count, [](const std::shared_ptr<Ranks>& ranks) {
        const Array array, expected;
        array[numbers / 2] = ranks->rank() == 0 ? 0.0 : -0.0;
        array[numbers / 4] = expected[numbers / 4] = ranks->rank();
        expected[numbers / 2] = 0;
        array.keep_once(*ranks);
        EXPECT_EQ(array, expected);
        EXPECT_EQ(std::signbit(array[numbers / 2]), ranks->rank() != 0);
        (void)ranks->largest(0);
    });
}

/// Arrays that do not begin at a page, of other lengths, or of one process alone are left alone.
TEST(Replicas, AreLeftAloneWhereTheyDoNotMatch) {
    support::on_ranks(count, [](const std::shared_ptr<Ranks>& ranks) {
        const auto rank = static_cast<std::size_t>(ranks->rank());
        const Array shifted, longer, lone, expected;
        for (std::size_t k = 0; k + 2 * rank < numbers; ++k) shifted[k + 2 * rank] = expected[k];
        Replicas replicas;
        replicas.add(std::as_bytes(std::span(shifted.begin() + 2 * rank, shifted.end())));
        replicas.add(std::as_bytes(std::span(longer.begin(), longer.end() - page * rank)));
        replicas.add(std::as_bytes(std::span(lone.begin(), rank == 1 ? numbers : 0)));
        replicas.keep_once(*ranks);
        EXPECT_TRUE(std::equal(shifted.begin() + 2 * rank, shifted.end(), expected.begin()));
        EXPECT_EQ(longer, expected);
        EXPECT_EQ(lone, expected);
        (void)ranks->largest(0);
    });
}

TEST(ForgottenArrays, AreZeroAndTakeNoMemory) {
    const auto forget_and_read = [](Array& array, Ranks&) {
        forget({array.begin(), numbers});
        EXPECT_EQ(std::accumulate(array.begin(), array.end(), 0.0), 0);
    };
    EXPECT_NEAR(saved(nothing, forget_and_read), count * array_bytes, precision);
}

/// Whoever gets the memory of an array that was kept once does not find its numbers there again.
TEST(ForgottenArrays, AreZeroWhereReplicasWere) {
    support::on_ranks(count, [](const std::shared_ptr<Ranks>& ranks) {
        const Array array;
        array.keep_once(*ranks);
        forget({array.begin(), numbers});
        EXPECT_EQ(std::accumulate(array.begin(), array.end(), 0.0), 0);
        (void)ranks->largest(0);
    });
}

} // namespace
} // namespace osculate
