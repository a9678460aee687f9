#include "osculate/time/step_control.hpp"
#include "support/random.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace osculate::time::OSCULATE_THIS_FILE {
namespace {

/// Steps of fit_to() up to `end`.
std::vector<FittedStep> march(double dt, const std::vector<double>& targets, double end) {
    std::vector<FittedStep> steps;
    for (double t = 0; t < end && steps.size() < 10000;) {
        steps.push_back(fit_to(t, dt, targets));
        t = steps.back().time;
    }
    return steps;
}

TEST(FitTo, HitsEveryTargetExactly) {
    const std::vector<double> targets{0.1, 1. / 3, 0.7, std::sqrt(0.5), 1.9};
    for (const double dt : {0.001, 0.0123, 0.07, 0.25, 1., 10.}) {
        std::vector<double> hit;
        for (const FittedStep& step : march(dt, targets, targets.back()))
            if (step.on_target) hit.push_back(step.time);
        EXPECT_EQ(hit, targets) << dt;
    }
}

TEST(FitTo, LeavesNoSliverAndTakesNoLongerStep) {
    constexpr double stretch = 1e-9; // relative; round-off, not time
    support::Random random(4);
    for (int i = 0; i < 1000; ++i) {
        const double dt = random.uniform(0.01, 0.5);
        for (const FittedStep& step : march(dt, {1}, 1)) {
            EXPECT_LE(step.dt, dt * (1 + 2 * stretch));
            EXPECT_GT(step.dt, 0.499 * dt);
        }
    }
}

TEST(FitTo, HalvesTheLastTwoSteps) {
    const FittedStep first = fit_to(0.5, 0.4, std::vector<double>{1});
    EXPECT_FALSE(first.on_target);
    EXPECT_DOUBLE_EQ(first.dt, 0.25);
    const FittedStep second = fit_to(first.time, 0.4, std::vector<double>{1});
    EXPECT_TRUE(second.on_target);
    EXPECT_EQ(second.time, 1);
    EXPECT_DOUBLE_EQ(second.dt, 0.25);
}

TEST(FitTo, EqualStepsStayEqualInSpiteOfRoundOff) {
    for (const int n : {3, 7, 10, 30, 1000}) EXPECT_EQ(march(1. / n, {1}, 1).size(), static_cast<std::size_t>(n));
}

TEST(FitTo, TargetsEqualButForRoundOffAreOne) {
    const double sum = 0.1 + 0.2;
    ASSERT_GT(sum, 0.3);
    const FittedStep step = fit_to(0, 1, std::vector<double>{0.3, sum, 2});
    EXPECT_EQ(step.time, sum);
    EXPECT_EQ(fit_to(0.3, 1, std::vector<double>{0.3, sum, 1}).time, 1);
}

TEST(FitTo, RunsFreelyBeyondTheLastTarget) {
    const FittedStep step = fit_to(3, 0.25, std::vector<double>{1, 2});
    EXPECT_EQ(step.time, 3.25);
    EXPECT_EQ(step.dt, 0.25);
    EXPECT_FALSE(step.on_target);
}

TEST(Corners, AreThoseWithinTheStageThatNoStepHitsAnyway) {
    using ::testing::ElementsAre;
    using ::testing::IsEmpty;
    EXPECT_THAT(corners_between({0.7, 0.1, 0.1, 0.5, 1, 3}, 10, 1, 4), ElementsAre(10 + 0.1, 10 + 0.7));
    EXPECT_THAT(corners_between({0, 0.25, 3 * 0.1 - 0.3, 0.5 + 1e-13, 1 - 1e-13}, 0, 1, 4), IsEmpty());
    EXPECT_THAT(corners_between({0.1, 0.1 + 1e-13, 0.3}, 0, 1, 1), ElementsAre(0.1, 0.3));
    EXPECT_THAT(corners_between({}, 0, 1, 4), IsEmpty());
}

} // namespace
} // namespace osculate::time::OSCULATE_THIS_FILE
