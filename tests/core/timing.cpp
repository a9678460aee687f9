#include "osculate/core/timing.hpp"

#include <gtest/gtest.h>
#include <thread>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

TEST(Timings, StartAtZeroAndAddUpPartByPart) {
    Timings timings;
    for (std::size_t part = 0; part < static_cast<std::size_t>(Part::count); ++part)
        EXPECT_EQ(timings[static_cast<Part>(part)], 0);
    timings.add(Part::factor, 1.5);
    timings.add(Part::factor, 2);
    timings.add(Part::output, 0.25);
    EXPECT_EQ(timings[Part::factor], 3.5);
    EXPECT_EQ(timings[Part::output], 0.25);
    EXPECT_EQ(timings[Part::solve], 0);
}

TEST(ScopedTimer, AddsItsLifetimeToItsPart) {
    Timings timings;
    const auto nap = std::chrono::milliseconds(2); // a lower bound only: nothing here depends on the machine's speed
    {
        const ScopedTimer timer(timings, Part::search);
        std::this_thread::sleep_for(nap);
        EXPECT_EQ(timings[Part::search], 0) << "added before its end";
    }
    EXPECT_GE(timings[Part::search], std::chrono::duration<double>(nap).count());
    EXPECT_EQ(timings[Part::contact], 0);
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
