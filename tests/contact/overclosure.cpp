#include "osculate/contact/overclosure.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <string>
#include <vector>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

constexpr double p0 = 2e6, c0 = 1e-4, k = 3e10; // Pa, m, Pa/m
constexpr double round_off = 1e-12;             // of a few products and a logarithm

struct Law {
    std::string name;
    Overclosure law;
};

class OverclosureLaw : public testing::TestWithParam<Law> {};

TEST_P(OverclosureLaw, IsTheInverseOfItsPressure) {
    const Overclosure& law = GetParam().law;
    for (const double p : {1e-3 * p0, 5e-3 * p0, 0.02 * p0, 0.3 * p0, 0.9 * p0, 3 * p0, 100 * p0}) {
        const Overclosure::Point at = law.at(p);
        EXPECT_NEAR(law.pressure(at.overclosure), p, round_off * p);
        const double d = 1e-6 * p; // curvature d/p, round-off 1e-16 c0 over d h' ~ 1e-6 c0
        const double difference = (law.at(p + d).overclosure - law.at(p - d).overclosure) / (2 * d);
        EXPECT_NEAR(at.compliance, difference, 1e-8 * difference) << p;
    }
}

TEST_P(OverclosureLaw, HasNoPressureBeforeItBegins) {
    const Overclosure& law = GetParam().law;
    EXPECT_EQ(law.pressure(law.first()), 0);
    EXPECT_EQ(law.pressure(law.first() - 1), 0);
    EXPECT_EQ(law.energy(law.first() - 1), 0);
    EXPECT_NEAR(law.at(0).overclosure, law.first(), round_off * c0);
    EXPECT_LT(law.at(-p0).overclosure, law.first()) << "a tension asks for a gap";
}

TEST_P(OverclosureLaw, StoresTheWorkOfItsPressure) {
    const Overclosure& law = GetParam().law;
    const double end = law.at(5 * p0).overclosure;
    constexpr int intervals = 200000; // midpoint rule: (growth * step)^2 / 24 = 2e-10, and a kink a row
    double sum = 0;
    for (int i = 0; i < intervals; ++i)
        sum +=
            law.pressure(law.first() + (i + 0.5) / intervals * (end - law.first())) / intervals * (end - law.first());
    EXPECT_NEAR(law.energy(end), sum, 1e-8 * sum);
}

INSTANTIATE_TEST_SUITE_P(
    All, OverclosureLaw,
    testing::Values(Law{"linear", Overclosure::linear(k)}, Law{"exponential", Overclosure::exponential(p0, c0)},
                    Law{"tabular", Overclosure::table({{-c0, 0}, {0, 0.1 * p0}, {0.5 * c0, p0}, {2 * c0, 1.1 * p0}})}),
    [](const auto& one) { return one.param.name; });

TEST(ExponentialOverclosure, HasItsPressureAtTouchAndAHundredthAtTheClearance) {
    const Overclosure law = Overclosure::exponential(p0, c0);
    EXPECT_NEAR(law.pressure(0), p0, round_off * p0);
    EXPECT_NEAR(law.pressure(-c0), 0.01 * p0, round_off * p0);
    EXPECT_NEAR(law.pressure(c0), 100 * p0, 100 * round_off * p0);
}

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
