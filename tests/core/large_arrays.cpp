/// Large arrays of a program that shares its run, see src/large_arrays.cpp, which is linked into this test.
#include "osculate/core/shared_pages.hpp"
#include "support/thread_ranks.hpp"

#include <array>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>
#include <memory>
#include <new>
#include <numeric>
#include <string>
#include <sys/mman.h>
#include <thread>
#include <vector>

namespace osculate {
namespace {

bool begins_at_page(const void* array) {
    return reinterpret_cast<std::uintptr_t>(array) % Replicas::page == 0;
}

class LargeArrays : public testing::Test {
protected:
    void SetUp() override {
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
        GTEST_SKIP() << "sanitizers have operators of their own";
#endif
        Replicas::arrays_begin_at_pages = true;
    }
    void TearDown() override {
        Replicas::arrays_begin_at_pages = false;
    }
};

TEST_F(LargeArrays, BeginAtAPageIfTheyAreLarge) {
    for (const std::size_t bytes : {Replicas::few, Replicas::few + 1, 3 * Replicas::few + 100}) {
        const std::vector<char> array(bytes, 'a');
        EXPECT_TRUE(begins_at_page(array.data())) << bytes;
        EXPECT_EQ(array.back(), 'a');
    }
    Replicas::arrays_begin_at_pages = false; // malloc puts its own numbers before an array
    const std::vector<char> array(3 * Replicas::few);
    EXPECT_FALSE(begins_at_page(array.data()));
}

TEST_F(LargeArrays, GoBackToTheSystem) {
    const void* place = nullptr;
    {
        const std::vector<char> array(Replicas::few, 'a');
        place = array.data();
    }
    unsigned char there = 0;
    EXPECT_NE(mincore(const_cast<void*>(place), Replicas::page, &there), 0) << "nothing is mapped there";
}

TEST_F(LargeArrays, LeaveOthersToTheLibrary) {
    Replicas::arrays_begin_at_pages = false;
    auto before = std::make_unique<std::vector<double>>(Replicas::few);
    Replicas::arrays_begin_at_pages = true;
    before.reset();
    std::vector<std::unique_ptr<std::array<char, 48>>> small;
    int at_page = 0; // by chance
    for (int k = 0; k < 2000; ++k) {
        small.push_back(std::make_unique<std::array<char, 48>>());
        at_page += begins_at_page(small.back().get()) ? 1 : 0;
    }
    EXPECT_GT(at_page, 0);
    small.clear();
    ::operator delete(nullptr);
    EXPECT_EQ(std::vector<double>(10, 1.0).back(), 1.0);
}

/// What the list of arrays allocates for itself begins at a page now and then, too.
TEST_F(LargeArrays, MayBeManyAndOfSeveralThreads) {
    constexpr int count = 500; // their pages take no memory until they are written
    const auto allocate_and_free = [] {
        std::vector<std::unique_ptr<char[]>> arrays;
        for (int k = 0; k < count; ++k) {
            arrays.push_back(std::make_unique_for_overwrite<char[]>(Replicas::few));
            arrays.back()[0] = static_cast<char>(k);
        }
        for (int k = 0; k < count; ++k) EXPECT_EQ(arrays[static_cast<std::size_t>(k)][0], static_cast<char>(k));
    };
    std::vector<std::thread> threads;
    for (int t = 0; t < 3; ++t) threads.emplace_back(allocate_and_free);
    for (std::thread& thread : threads) thread.join();
}

TEST_F(LargeArrays, AreKeptOnceAsVectors) {
    support::on_ranks(2, [](const std::shared_ptr<Ranks>& ranks) {
        std::vector<double> array(Replicas::few);
        std::iota(array.begin(), array.end(), 0.5);
        const std::vector<double> expected = array;
        Replicas replicas;
        replicas.add(array);
        replicas.keep_once(*ranks);
        std::ifstream maps("/proc/self/maps");
        char text[32];
        std::snprintf(text, sizeof text, "%lx-", reinterpret_cast<unsigned long>(array.data()));
        bool mapped = false;
        for (std::string line; std::getline(maps, line);)
            mapped = mapped || (line.starts_with(text) && line.find("memfd:osculate") != std::string::npos);
        EXPECT_TRUE(mapped);
        EXPECT_EQ(array, expected);
        array.front() = ranks->rank();
        (void)ranks->largest(0);
        EXPECT_EQ(array.front(), ranks->rank());
        (void)ranks->largest(0);
    });
}

} // namespace
} // namespace osculate
