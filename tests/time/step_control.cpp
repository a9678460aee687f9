#include "osculate/time/step_control.hpp"

#include "support/floating_point_traps.hpp"
#include "support/random.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <limits>

namespace osculate::time::OSCULATE_THIS_FILE {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr double round_off = 1e-15; // relative; one division and two sums

/// One point that falls from g0 to g1.
StepEvidence falling(double g0, double g1) {
    StepEvidence evidence;
    evidence.gaps = {{g0, g1, 2, 7}};
    return evidence;
}

StepLimits allowing(double g_p) {
    StepLimits limits;
    limits.allowed_interpenetration = g_p;
    limits.smallest_lambda = 0;
    limits.reserve = 1;
    return limits;
}

TEST(ReductionFactor, EndsOnTheSurfaceForAPointAwayFromIt) {
    support::Random random(1);
    for (int i = 0; i < 1000; ++i) {
        const double g_p = random.uniform(1e-6, 1), g0 = random.uniform(g_p, 10), g1 = -g_p - random.uniform(1e-6, 10);
        const double lambda = reduction_factor(g0, g1, g_p);
        EXPECT_NEAR(lambda, g0 / (g0 - g1), round_off * lambda);
        EXPECT_NEAR(g0 + lambda * (g1 - g0), 0, 4 * round_off * (g0 - g1));
    }
}

TEST(ReductionFactor, EndsAtTheAllowedInterpenetrationForAPointAtTheSurfaceOrBelow) {
    support::Random random(2);
    for (int i = 0; i < 1000; ++i) {
        const double g_p = random.uniform(1e-6, 1), g0 = random.uniform(-g_p, g_p);
        const double g1 = -g_p - random.uniform(1e-6, 10), lambda = reduction_factor(g0, g1, g_p);
        EXPECT_NEAR(lambda, (g_p + g0) / (g0 - g1), round_off);
        EXPECT_NEAR(g0 + lambda * (g1 - g0), -g_p, 4 * round_off * (g_p - g1));
    }
    EXPECT_GT(reduction_factor(0, -1, 0.1), 0); // (27) would stand still here
    EXPECT_DOUBLE_EQ(reduction_factor(0, -1, 0.1), 0.1);
    EXPECT_DOUBLE_EQ(reduction_factor(0.1, -1, 0.1), 0.1 / 1.1); // (27) from g0 = g_p on
}

TEST(ReductionFactor, IsOneUpToTheAllowedInterpenetration) {
    for (const double g0 : {-0.3, -0.1, 0., 0.05, 3.})
        for (const double g1 : {-0.1, 0., 2.}) EXPECT_EQ(reduction_factor(g0, g1, 0.1), 1);
    EXPECT_LT(reduction_factor(3, -0.1 * (1 + 1e-12), 0.1), 1);
}

TEST(ReductionFactor, IsZeroWhereNoFractionIsAdmissible) {
    EXPECT_EQ(reduction_factor(-0.1, -1, 0.1), 0);
    EXPECT_EQ(reduction_factor(-0.5, -1, 0.1), 0);
    EXPECT_EQ(reduction_factor(-2, -1, 0.1), 0); // rises, and (28) would be above 1
    EXPECT_EQ(reduction_factor(-1, -1, 0.1), 0);
}

TEST(StepControl, CutsAStepWithAForceFarFromTheMasterAndNamesItInTheEnd) {
    StepEvidence evidence;
    evidence.far = FarForce{.pair = 1, .slave = 5, .force = 7, .distance = 0.5, .excess = 0.3, .length = 2};
    StepLimits limits;
    limits.audited_depth = 0.2;
    EXPECT_EQ(judge(evidence, limits, 1, 0).verdict, Verdict::accept) << "0.15 of a facet";
    limits.audited_depth = 0.1;
    Decision decision = judge(evidence, limits, 1, 0);
    EXPECT_EQ(decision.verdict, Verdict::retry);
    EXPECT_EQ(decision.reason, Reason::distance);
    EXPECT_EQ(decision.dt, limits.failure_lambda);
    EXPECT_EQ(decision.pair, 1);
    EXPECT_EQ(decision.slave, 5);
    EXPECT_EQ(decision.value, 0.5);
    limits.dt_min = 1;
    decision = judge(evidence, limits, 1, 0);
    EXPECT_EQ(decision.verdict, Verdict::give_up);
    EXPECT_THAT(decision.cause, AllOf(HasSubstr("across 0.5 m"), HasSubstr("allowed is 0.4 m"), HasSubstr("dt_min")));
    const support::FloatingPointTraps suspended(false); // a comparison with NaN is an invalid operation
    evidence.far->excess = std::numeric_limits<double>::quiet_NaN();
    limits.audited_depth = 0.9;
    EXPECT_EQ(judge(evidence, limits, 1, 0).verdict, Verdict::give_up) << "what is no number objects";
}

TEST(StepControl, AcceptsAndRemembersTheResidualWhenNothingObjects) {
    StepEvidence evidence = falling(1, -0.1);
    evidence.residual = 3e-11;
    const Decision decision = judge(evidence, allowing(0.1), 0.5, 0);
    EXPECT_EQ(decision.verdict, Verdict::accept);
    EXPECT_EQ(decision.reason, Reason::none);
    EXPECT_EQ(decision.lambda, 1);
    EXPECT_EQ(decision.value, 3e-11);
    EXPECT_EQ(decision.pair, -1);
    EXPECT_EQ(decision.cause, "");
    EXPECT_EQ(judge({}, StepLimits{}, 0.5, 0).verdict, Verdict::accept);
}

TEST(StepControl, TakesTheSmallestFactorOfManyPoints) {
    support::Random random(3);
    for (int round = 0; round < 50; ++round) {
        StepEvidence evidence;
        double smallest = 1;
        Index slave = -1;
        for (Index i = 0; i < 200; ++i) {
            const double g0 = random.uniform(-0.05, 1), g1 = random.uniform(-1, 1);
            evidence.gaps.push_back({g0, g1, 1, i});
            if (const double lambda = reduction_factor(g0, g1, 0.1); lambda < smallest) {
                smallest = lambda;
                slave = i;
            }
        }
        const Decision decision = judge(evidence, allowing(0.1), 0.25, 0);
        EXPECT_EQ(decision.verdict, Verdict::retry);
        EXPECT_EQ(decision.reason, Reason::interpenetration);
        EXPECT_EQ(decision.lambda, smallest);
        EXPECT_EQ(decision.dt, smallest * 0.25);
        EXPECT_EQ(decision.pair, 1);
        EXPECT_EQ(decision.slave, slave);
        EXPECT_EQ(decision.value, evidence.gaps[static_cast<std::size_t>(slave)].g1);
    }
}

TEST(StepControl, TheSmallestFactorNeedNotBeTheDeepestPoints) {
    StepEvidence evidence;
    evidence.gaps = {{4, -1, 0, 0}, {0.2, -0.3, 0, 1}};
    const Decision decision = judge(evidence, allowing(0.1), 1, 0);
    EXPECT_EQ(decision.slave, 1);
    EXPECT_DOUBLE_EQ(decision.lambda, 0.4);
    EXPECT_EQ(decision.value, -0.3);
}

TEST(StepControl, AllowedInterpenetrationMayBeAFractionOfALengthAtThePoint) {
    StepEvidence evidence;
    evidence.gaps = {{1, -0.3, 0, 0, 4.}, {1, -0.3, 0, 1, 2.}}; // 0.1 of 4 m admits 0.4 m, of 2 m only 0.2 m
    const Decision decision = judge(evidence, allowing(0.1), 1, 0);
    EXPECT_EQ(decision.slave, 1);
    EXPECT_DOUBLE_EQ(decision.lambda, 1 / 1.3);
    evidence.gaps.pop_back();
    EXPECT_EQ(judge(evidence, allowing(0.1), 1, 0).verdict, Verdict::accept);
}

TEST(StepControl, LambdaHasAFloor) {
    StepLimits limits = allowing(1e-3);
    limits.smallest_lambda = 0.2;
    const Decision decision = judge(falling(0, -1), limits, 0.5, 0);
    EXPECT_EQ(decision.lambda, 0.2);
    EXPECT_EQ(decision.dt, 0.1);
    EXPECT_EQ(judge(falling(-1, -2), limits, 0.5, 0).lambda, 0.2); // no fraction would do
}

TEST(StepControl, AimsShortOfABoundButNotOfTheSurface) {
    StepLimits limits = allowing(0.1);
    limits.reserve = 0.9;
    EXPECT_DOUBLE_EQ(judge(falling(1, -1), limits, 1, 0).lambda, 0.5);
    EXPECT_DOUBLE_EQ(judge(falling(0, -1), limits, 1, 0).lambda, 0.9 * 0.1);
}

TEST(StepControl, TriesTheSmallestStepBeforeGivingUpAndNamesTheCause) {
    StepLimits limits = allowing(1e-3);
    limits.dt_min = 0.01;
    const Decision cut = judge(falling(0, -1), limits, 0.5, 0);
    EXPECT_EQ(cut.verdict, Verdict::retry);
    EXPECT_EQ(cut.dt, 0.01);
    EXPECT_DOUBLE_EQ(cut.lambda, 1e-3);

    const Decision end = judge(falling(0, -1), limits, cut.dt, 1);
    EXPECT_EQ(end.verdict, Verdict::give_up);
    EXPECT_EQ(end.reason, Reason::interpenetration);
    EXPECT_EQ(end.dt, 0.01);
    EXPECT_EQ(end.pair, 2);
    EXPECT_EQ(end.slave, 7);
    EXPECT_EQ(end.value, -1);
    EXPECT_THAT(end.cause, HasSubstr("the trial has a gap of -1 m, allowed is -0.001 m"));
    EXPECT_THAT(end.cause, HasSubstr("dt_min is 0.01 s"));
    EXPECT_EQ(judge(falling(0, -1), limits, 0.01 * (1 + 1e-9), 1).verdict, Verdict::give_up); // stretched to a target
}

TEST(StepControl, GivesUpAfterTheMostRepeats) {
    StepLimits limits = allowing(0.1);
    limits.most_repeats = 3;
    EXPECT_EQ(judge(falling(1, -1), limits, 1, 2).verdict, Verdict::retry);
    const Decision end = judge(falling(1, -1), limits, 1, 3);
    EXPECT_EQ(end.verdict, Verdict::give_up);
    EXPECT_EQ(end.reason, Reason::interpenetration);
    EXPECT_THAT(end.cause, HasSubstr("repeated 3 times"));
    EXPECT_EQ(judge({}, limits, 1, 3).verdict, Verdict::accept);
}

TEST(StepControl, EveryObjectionGivesUpUnderItsOwnName) {
    StepLimits limits = allowing(0.1);
    limits.dt_min = 1;
    limits.error_tolerance = limits.energy_tolerance = 1e-3;
    StepEvidence solver, error, energy, collision;
    solver.solved = false;
    error.local_error = energy.energy_jump = 1;
    collision.collision = 0.3;
    const std::vector<std::pair<StepEvidence, Reason>> cases{{solver, Reason::solver},
                                                             {falling(1, -1), Reason::interpenetration},
                                                             {collision, Reason::collision},
                                                             {error, Reason::error},
                                                             {energy, Reason::energy}};
    for (const auto& [evidence, reason] : cases) {
        const Decision decision = judge(evidence, limits, 1, 0);
        EXPECT_EQ(decision.verdict, Verdict::give_up) << name(reason);
        EXPECT_EQ(decision.reason, reason) << name(reason);
        EXPECT_THAT(decision.cause, HasSubstr("dt_min is 1 s")) << name(reason);
        EXPECT_GT(decision.cause.find(';'), 10u) << "the cause itself comes first: " << decision.cause;
    }
}

/// A step that nothing but a shock of contact speaks against.
std::vector<std::pair<StepEvidence, const char*>> shocks() {
    StepEvidence solver, velocity, energy, closing;
    solver.solved = false;
    velocity.velocity_error = energy.energy_jump = closing.closing_energy = 1;
    return {{solver, "solver"}, {velocity, "velocity"}, {energy, "energy"}, {closing, "closing"}};
}

StepLimits settling() {
    StepLimits limits;
    limits.velocity_error = limits.energy_tolerance = limits.closing_energy = 1e-3;
    limits.inelastic_impacts = true;
    return limits;
}

TEST(StepControl, AShockIsRepeatedAsAnImpactOfTheSameStep) {
    for (const auto& [evidence, what] : shocks()) {
        const Decision decision = judge(evidence, settling(), 0.5, 0);
        EXPECT_EQ(decision.verdict, Verdict::retry) << what;
        EXPECT_EQ(decision.reason, Reason::impact) << what;
        EXPECT_EQ(decision.dt, 0.5) << what;
        EXPECT_TRUE(decision.impact) << what;
        StepLimits resolved = settling();
        resolved.inelastic_impacts = false;
        const Decision cut = judge(evidence, resolved, 0.5, 0);
        EXPECT_LT(cut.dt, 0.5) << what;
        EXPECT_FALSE(cut.impact) << what;
    }
    // paths and depths ask for shorter steps, whoever makes them
    StepEvidence path;
    path.collision = 0.3;
    EXPECT_EQ(judge(path, settling(), 0.5, 0).reason, Reason::collision);
}

TEST(StepControl, AnImpactMayLoseEnergyButNotGainIt) {
    const std::vector<std::string> cut{"solver", "energy"};
    for (auto [evidence, what] : shocks()) {
        evidence.impact = true;
        const bool objects = std::ranges::find(cut, what) != cut.end();
        const Decision decision = judge(evidence, settling(), 0.5, 0);
        EXPECT_EQ(decision.verdict, objects ? Verdict::retry : Verdict::accept) << what;
        if (objects) {
            EXPECT_EQ(decision.dt, 0.25) << what;
            EXPECT_TRUE(decision.impact) << what;
        }
    }
}

TEST(StepControl, AnImpactGoesOnUntilVelocitiesNoLongerJump) {
    StepEvidence evidence;
    evidence.impact = true;
    evidence.velocity_error = 1.1e-3;
    EXPECT_TRUE(judge(evidence, settling(), 0.5, 0).impact);
    evidence.velocity_error = 0.9e-3;
    EXPECT_FALSE(judge(evidence, settling(), 0.5, 0).impact);
    evidence.forced = true; // the same once more
    EXPECT_TRUE(judge(evidence, settling(), 0.5, 0).impact);
}

TEST(StepControl, AFailedSolveIsHalvedAndItsGapsMeanNothing) {
    StepEvidence evidence = falling(1, -100);
    evidence.solved = false;
    evidence.residual = 0.7;
    const Decision decision = judge(evidence, allowing(0.1), 1, 0);
    EXPECT_EQ(decision.reason, Reason::solver);
    EXPECT_EQ(decision.lambda, 0.5);
    EXPECT_EQ(decision.value, 0.7);
    EXPECT_EQ(decision.slave, -1);
}

TEST(StepControl, CutsWhereANodeIsDeepAndNoAverageSeesIt) {
    StepLimits limits; // without a bound on what is seen
    StepEvidence evidence;
    const double least = limits.unseen_interpenetration;
    evidence.unseen = {0, -1.1 * least * 2, 3, 5, 2}; // a facet of 2 m
    const Decision decision = judge(evidence, limits, 1, 0);
    EXPECT_EQ(decision.verdict, Verdict::retry);
    EXPECT_EQ(decision.reason, Reason::interpenetration);
    EXPECT_TRUE(decision.unseen);
    EXPECT_EQ(decision.pair, 3);
    EXPECT_EQ(decision.slave, 5);
    EXPECT_EQ(decision.dt, limits.failure_lambda);
    evidence.unseen.g1 = -0.9 * least * 2;
    EXPECT_EQ(judge(evidence, limits, 1, 0).verdict, Verdict::accept);
    const support::FloatingPointTraps suspended(false);
    evidence.unseen.g1 = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(judge(evidence, limits, 1, 0).verdict, Verdict::retry);
}

TEST(StepControl, CutsForTimeErrorByItsOrder) {
    StepLimits limits;
    limits.error_tolerance = 1e-6;
    StepEvidence evidence;
    evidence.local_error = 8e-6; // dt^3: half the step has an eighth of the error
    const Decision decision = judge(evidence, limits, 1, 0);
    EXPECT_EQ(decision.reason, Reason::error);
    EXPECT_EQ(decision.value, 8e-6);
    EXPECT_DOUBLE_EQ(decision.lambda, limits.reserve * 0.5);
    evidence.local_error = 1e-6;
    EXPECT_EQ(judge(evidence, limits, 1, 0).verdict, Verdict::accept);
}

/// Both fall with the square of the step.
TEST(StepControl, CutsForTheErrorOfVelocitiesAndForClosingGaps) {
    StepLimits limits;
    limits.velocity_error = limits.closing_energy = 0.01;
    for (const Reason reason : {Reason::error, Reason::closing_energy}) {
        StepEvidence evidence;
        double& found = reason == Reason::error ? evidence.velocity_error : evidence.closing_energy;
        found = 0.04;
        const Decision decision = judge(evidence, limits, 1, 0);
        EXPECT_EQ(decision.verdict, Verdict::retry);
        EXPECT_EQ(decision.reason, reason);
        EXPECT_EQ(decision.value, 0.04);
        EXPECT_DOUBLE_EQ(decision.lambda, limits.reserve * 0.5);
        EXPECT_THAT(decision.cause, HasSubstr("0.04"));
        found = 0.01;
        EXPECT_EQ(judge(evidence, limits, 1, 0).verdict, Verdict::accept);
    }
}

TEST(StepControl, AcceptsTheSmallestStepWhateverVelocitiesAndClosingGapsLose) {
    StepLimits limits;
    limits.velocity_error = limits.closing_energy = 0.01;
    limits.dt_min = 1;
    StepEvidence evidence;
    evidence.velocity_error = evidence.closing_energy = 0.5;
    EXPECT_EQ(judge(evidence, limits, 1, 0).verdict, Verdict::accept);
    EXPECT_EQ(judge(evidence, limits, 2, 0).verdict, Verdict::retry);
    evidence.energy_jump = 1;
    limits.energy_tolerance = 0.5;
    EXPECT_EQ(judge(evidence, limits, 1, 0).reason, Reason::energy);
}

/// As where a node with mass lands: its own energy goes at once.
TEST(StepControl, DoesNotCutForALossThatCutsDoNotLessen) {
    StepLimits limits;
    limits.closing_energy = 0.01;
    StepEvidence evidence;
    evidence.closing_energy = 0.5;
    evidence.closes_anyhow = true;
    EXPECT_EQ(judge(evidence, limits, 1, 1).verdict, Verdict::accept);
}

TEST(StepControl, GrowsNoFurtherThanTheErrorOfVelocitiesAdmits) {
    StepLimits limits;
    limits.velocity_error = 0.01;
    limits.growth = 3;
    StepEvidence evidence;
    evidence.velocity_error = 0.01 / 4;
    EXPECT_DOUBLE_EQ(judge(evidence, limits, 1, 0).dt, limits.reserve * 2);
    evidence.velocity_error = 0.01;
    EXPECT_DOUBLE_EQ(judge(evidence, limits, 1, 0).dt, 1);
}

TEST(StepControl, CutsForAnEnergyJump) {
    StepLimits limits;
    limits.energy_tolerance = 1e-6;
    StepEvidence evidence;
    evidence.energy_jump = 2e-6;
    const Decision decision = judge(evidence, limits, 1, 0);
    EXPECT_EQ(decision.reason, Reason::energy);
    EXPECT_EQ(decision.lambda, 0.5);
    EXPECT_EQ(decision.value, 2e-6);
}

TEST(StepControl, CutsToACollision) {
    StepEvidence evidence;
    evidence.collision = 0.4;
    evidence.collision_pair = 1;
    evidence.collision_slave = 7;
    const Decision decision = judge(evidence, StepLimits{}, 1, 0);
    EXPECT_EQ(decision.reason, Reason::collision);
    EXPECT_EQ(decision.value, 0.4);
    EXPECT_DOUBLE_EQ(decision.lambda, 0.4);
    EXPECT_EQ(decision.pair, 1);
    EXPECT_EQ(decision.slave, 7);
}

TEST(StepControl, TheStrongestObjectionGoverns) {
    StepLimits limits = allowing(0.1);
    limits.error_tolerance = 1;
    StepEvidence evidence = falling(1, -1); // lambda 0.5
    evidence.local_error = 2;               // lambda 0.79
    EXPECT_EQ(judge(evidence, limits, 1, 0).reason, Reason::interpenetration);
    evidence.local_error = 1000; // lambda 0.1
    const Decision decision = judge(evidence, limits, 1, 0);
    EXPECT_EQ(decision.reason, Reason::error);
    EXPECT_EQ(decision.slave, -1);
}

TEST(StepControl, WhatIsNotANumberIsNeverAccepted) {
    const support::FloatingPointTraps suspended(false); // a comparison with NaN is an invalid operation
    const double nan = std::numeric_limits<double>::quiet_NaN();
    StepLimits limits;
    StepEvidence gap = falling(1, nan), error, energy, collision;
    error.local_error = energy.energy_jump = collision.collision = nan;
    limits.allowed_interpenetration = 0.1;
    for (const StepEvidence& evidence : {gap, error, energy, collision}) {
        const Decision decision = judge(evidence, limits, 1, 0);
        EXPECT_EQ(decision.verdict, Verdict::retry);
        EXPECT_GE(decision.dt, 0.1);
        EXPECT_LT(decision.dt, 1);
    }
}

TEST(StepControl, AForcedRepeatKeepsTheStepAndYieldsToRealObjections) {
    StepLimits limits = allowing(0.1);
    limits.dt_min = 0.7;
    limits.most_repeats = 0;
    StepEvidence evidence = falling(1, 0.5);
    evidence.forced = true;
    const Decision decision = judge(evidence, limits, 0.7, 0);
    EXPECT_EQ(decision.verdict, Verdict::retry);
    EXPECT_EQ(decision.reason, Reason::forced);
    EXPECT_EQ(decision.dt, 0.7);
    EXPECT_EQ(decision.lambda, 1);
    evidence.gaps.front().g1 = -1;
    EXPECT_EQ(judge(evidence, limits, 0.7, 0).reason, Reason::interpenetration);
}

} // namespace
} // namespace osculate::time::OSCULATE_THIS_FILE
