/// The traps that every test runs under do end a program that makes a NaN or an infinity.

#include "support/floating_point_traps.hpp"

#include <cfenv>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <thread>

namespace osculate::support::OSCULATE_THIS_FILE {
namespace {

volatile double zero = 0, one = 1, largest = std::numeric_limits<double>::max(); // read at run time
volatile double result = 0;

void divide_by_zero() {
    result = one / zero;
}
void make_nan() {
    result = zero / zero;
}
void overflow() {
    result = largest * largest;
}

// By a signal, or by the sanitizer that caught it.
TEST(FloatingPointTrapsDeathTest, EndTheProgramThatMakesANanOrAnInfinity) {
    EXPECT_DEATH(divide_by_zero(), "");
    EXPECT_DEATH(make_nan(), "");
    EXPECT_DEATH(overflow(), "");
}

TEST(FloatingPointTrapsDeathTest, HoldInThreadsToo) {
    EXPECT_DEATH(std::thread(make_nan).join(), "");
}

TEST(FloatingPointTraps, AreSuspendedAndBackAfterwards) {
    const int before = fegetexcept();
    {
        const FloatingPointTraps suspended(false);
        EXPECT_EQ(fegetexcept() & FloatingPointTraps::trapped, 0);
        divide_by_zero();
        EXPECT_TRUE(std::isinf(result));
        {
            const FloatingPointTraps back;
            EXPECT_EQ(fegetexcept() & FloatingPointTraps::trapped, FloatingPointTraps::trapped);
        }
    }
    EXPECT_EQ(fegetexcept(), before);
    EXPECT_EQ(before & FloatingPointTraps::trapped, FloatingPointTraps::trapped) << "main of the tests sets them";
}

} // namespace
} // namespace osculate::support::OSCULATE_THIS_FILE
