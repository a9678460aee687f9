/// Steps that grow again, and whole falls of one point under the rules of the step.

#include "osculate/time/step_control.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace osculate::time::OSCULATE_THIS_FILE {
namespace {

/// One point that falls from g0 to g1.
StepEvidence falling(double g0, double g1) {
    StepEvidence evidence;
    evidence.gaps = {{g0, g1, 2, 7}};
    return evidence;
}

TEST(StepGrowth, FollowsEasyStepsOnly) {
    StepLimits limits;
    limits.growth = 2;
    limits.easy_iterations = 4;
    StepEvidence evidence;
    evidence.iterations = 4;
    EXPECT_EQ(judge(evidence, limits, 0.1, 0).dt, 0.2);
    EXPECT_EQ(judge(evidence, limits, 0.1, 1).dt, 0.1); // had to be cut
    evidence.iterations = 5;
    EXPECT_EQ(judge(evidence, limits, 0.1, 0).dt, 0.1);
}

TEST(StepGrowth, EndsAtTheLargestStep) {
    StepLimits limits;
    limits.growth = 2;
    limits.dt_max = 0.15;
    EXPECT_EQ(judge({}, limits, 0.1, 0).dt, 0.15);
    EXPECT_EQ(judge({}, limits, 0.2, 0).dt, 0.15);
    EXPECT_EQ(judge({}, limits, 0.2, 1).dt, 0.15);
}

TEST(StepGrowth, StaysBelowWhatTheTimeErrorAdmits) {
    StepLimits limits;
    limits.growth = 3;
    limits.error_tolerance = 1;
    StepEvidence evidence;
    evidence.local_error = 0.125;
    EXPECT_DOUBLE_EQ(judge(evidence, limits, 1, 0).dt, limits.reserve * 2);
    evidence.local_error = 1e-9;
    EXPECT_EQ(judge(evidence, limits, 1, 0).dt, 3);
    evidence.local_error = 0.99; // no reserve left, but admissible as it is
    EXPECT_EQ(judge(evidence, limits, 1, 0).dt, 1);
}

struct Fall {
    int cuts = 0;
    bool gave_up = false;
    double deepest = 0, contact_time = 0; ///< largest trial interpenetration among accepted steps, m; s
};

/// A point falls until an accepted step ends below the surface, which is when it closes.
template <class Height> Fall fall(const Height& height, const StepLimits& limits, double dt) {
    Fall result;
    int repeats = 0;
    for (double t = 0; !result.gave_up;) {
        const Decision decision = judge(falling(height(t), height(t + dt)), limits, dt, repeats);
        if (decision.verdict == Verdict::accept) {
            t += dt;
            repeats = 0;
            result.deepest = std::max(result.deepest, -height(t));
            if (height(t) < 0) {
                result.contact_time = t;
                break;
            }
        } else {
            ++result.cuts;
            ++repeats;
            result.gave_up = decision.verdict == Verdict::give_up;
        }
        dt = decision.dt;
    }
    return result;
}

TEST(Fall, CutsGrowLikeTheLogarithmOfTheAllowedInterpenetration) {
    // A cut takes at most one decade of dt (the floor). One landing by (27) on the surface, one or more cuts there by (28)
    // once growth has made the step too long again: at constant speed no decade of g_p can cost more than two cuts.
    constexpr int most_per_decade = 2;
    for (const double speed : {1., 0.37, 2.9}) {
        const auto height = [&](double t) { return 1 - speed * t; };
        StepLimits limits;
        limits.dt_max = 0.4;
        int previous = 0;
        for (int decade = 2; decade <= 8; ++decade) {
            limits.allowed_interpenetration = std::pow(10., -decade);
            const Fall result = fall(height, limits, 0.4);
            EXPECT_FALSE(result.gave_up);
            EXPECT_LE(result.deepest, limits.allowed_interpenetration);
            EXPECT_NEAR(result.contact_time, 1 / speed, limits.allowed_interpenetration / speed * 1.001);
            EXPECT_LE(result.cuts, most_per_decade * decade) << speed;
            if (decade > 2) {
                EXPECT_LE(result.cuts - previous, most_per_decade) << speed;
            }
            previous = result.cuts;
        }
        EXPECT_GT(previous, 0) << speed;
    }
}

TEST(Fall, SpeedingUpAndSlowingDownArriveWithinTheAllowedInterpenetration) {
    const auto faster = [](double t) { return 1 - 0.1 * t - 4 * t * t; };
    const auto slower = [](double t) { return 1 - 2.5 * t + t * t; }; // through the surface at t = 0.5
    for (const double g_p : {1e-2, 1e-4, 1e-6}) {
        StepLimits limits;
        limits.allowed_interpenetration = g_p;
        limits.dt_max = 1;
        for (const Fall& result : {fall(faster, limits, 1.), fall(slower, limits, 1.)}) {
            EXPECT_FALSE(result.gave_up) << g_p;
            EXPECT_GT(result.deepest, 0) << g_p;
            EXPECT_LE(result.deepest, g_p) << g_p;
        }
    }
}

TEST(Fall, ReserveSavesASlowingPointFromCreepingUpToItsBound) {
    const double g_p = 1e-4;
    const auto height = [&](double t) { return 1.1 * g_p * (std::exp(-9 * t) - 1); }; // comes to rest 1.1 g_p deep
    StepLimits limits;
    limits.allowed_interpenetration = g_p;
    const Fall with = fall(height, limits, 1.);
    EXPECT_FALSE(with.gave_up);
    limits.reserve = 1; // every cut leaves three quarters of the excess
    const Fall without = fall(height, limits, 1.);
    EXPECT_TRUE(without.gave_up);
    EXPECT_LT(with.cuts, without.cuts / 2);
}

} // namespace
} // namespace osculate::time::OSCULATE_THIS_FILE
