#include "osculate/study/work_precision.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <limits>

namespace osculate::study::OSCULATE_THIS_FILE {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

constexpr double round_off = 1e-12;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();

TEST(PowerLaw, IsFoundAgainAndLeavesOutWhatHasNoLogarithm) {
    std::vector<CostPoint> points{{1, 0}, {2, nan}, {3, -1}, {nan, 1}};
    for (const double cost : {0.5, 2.0, 30.0}) points.push_back({cost, 7 * std::pow(cost, -1.5)});
    const auto law = fit_power_law(points);
    ASSERT_TRUE(law);
    EXPECT_NEAR(law->slope, -1.5, round_off);
    EXPECT_NEAR(law->factor, 7, 7 * round_off);
    EXPECT_EQ(law->least, 0.5);
    EXPECT_EQ(law->largest, 30);
    EXPECT_NEAR((*law)(4), 7. / 8, round_off);
}

TEST(PowerLaw, IsTheLeastSquaresOfLogarithms) {
    // logarithms to base 10: (0, 0), (1, 1), (2, 0): the best line is level at 1/3
    const auto law = fit_power_law({{1, 1}, {10, 10}, {100, 1}});
    ASSERT_TRUE(law);
    EXPECT_NEAR(law->slope, 0, round_off);
    EXPECT_NEAR(law->factor, std::pow(10, 1. / 3), 10 * round_off);
}

TEST(PowerLaw, NeedsTwoCosts) {
    EXPECT_FALSE(fit_power_law({}));
    EXPECT_FALSE(fit_power_law({{1, 2}}));
    EXPECT_FALSE(fit_power_law({{1, 2}, {1, 3}}));
}

TEST(ParetoFront, HoldsWhatNothingBeats) {
    EXPECT_THAT(pareto_front({{3, 1}, {1, 5}, {2, 6}, {2, 4}, {4, 1}, {5, 0}, {6, nan}}), ElementsAre(1, 3, 0, 5));
    EXPECT_THAT(pareto_front({{1, 1}, {1, 1}, {1, 2}}), ElementsAre(0)) << "of equals the first";
    EXPECT_THAT(pareto_front({{nan, 1}, {1, nan}}), IsEmpty());
}

TEST(CostRatio, ComparesTimesAtTheMiddleOfSharedErrors) {
    // error = 1/cost and 10/cost: ten times the cost at any error
    const std::vector<CostPoint> fast{{1, 1}, {10, 0.1}, {100, 0.01}}, slow{{10, 1}, {1000, 0.01}};
    const auto ratio = cost_ratio(slow, fast);
    ASSERT_TRUE(ratio);
    EXPECT_NEAR(ratio->ratio, 10, 10 * round_off);
    EXPECT_NEAR(ratio->error, 0.1, round_off);
    EXPECT_EQ(ratio->least, 0.01);
    EXPECT_EQ(ratio->largest, 1);
    EXPECT_NEAR(cost_ratio(fast, slow)->ratio, 0.1, round_off);
}

TEST(CostRatio, IsReadOffTheFrontsAndNotBeyondThem) {
    const std::vector<CostPoint> one{{1, 1}, {2, 5}, {4, 0.25}}, other{{1, 0.2}, {2, 0.1}}, point{{8, 0.5}};
    EXPECT_FALSE(cost_ratio(one, other)) << "no error in common";
    EXPECT_FALSE(cost_ratio({}, one));
    const auto ratio = cost_ratio(one, point); // one passes 0.5 half-way between 1 and 4
    ASSERT_TRUE(ratio);
    EXPECT_NEAR(ratio->ratio, 2. / 8, round_off);
}

TEST(Median, IsTheMiddle) {
    EXPECT_EQ(median({3, 1, 9}), 3);
    EXPECT_EQ(median({3, 1}), 2);
    EXPECT_EQ(median({5}), 5);
}

} // namespace
} // namespace osculate::study::OSCULATE_THIS_FILE
