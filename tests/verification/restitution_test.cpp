/// Rebounds with the steps that the scene's defaults make of a stage's long ones.

#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

struct Bounce {
    double restitution = 0;
    int steps = 0;      ///< accepted
    double contact = 0; ///< s
    double first = 0;   ///< s, start of the step in which it touches
    double closing = 0; ///< taken by closing gaps, of the energy at the end of the fall
};

/// Ratio of the speeds with which the centre leaves and arrives, freed from gravity's work by the heights.
Bounce steel_ball(const std::vector<scene::Override>& overrides = {}) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("validation/steel_ball.yaml"), overrides);
    Bounce result;
    result.steps = static_cast<int>(run.steps.size());
    double arrives = 0, leaves = 0, before = 0, last = 0;
    for (const support::RunStep& step : run.steps) {
        const bool touches = step.pairs[0].normal > 0;
        if (touches && result.first == 0) result.first = before;
        if (touches) last = step.time;
        if (result.first == 0) arrives = step.ledger.linear.z();
        before = step.time;
    }
    for (const support::RunStep& step : run.steps)
        if (step.time > last && leaves == 0) leaves = step.ledger.linear.z();
    result.restitution = -leaves / arrives;
    result.contact = last - result.first;
    result.closing = -run.steps.back().ledger.contact;
    return result;
}

TEST(SteelBall, ReboundsAsHighAsItFellWithoutAKey) {
    const Bounce found = steel_ball();
    EXPECT_GE(found.restitution, 0.97);
    EXPECT_LE(found.restitution, 1.001); // gravity's momentum during a step of the flight
    EXPECT_LT(found.steps, 260);         // 160 of a millisecond and those of the impact
    const double fall = std::sqrt(2 * 0.1 / 9.81), short_step = 1e-5;
    EXPECT_NEAR(found.first, fall, short_step);
    const double mass = 7800 * 4. / 3 * 3.14159265 * 1e-6, modulus = 210e9 / (1 - 0.09), v = 9.81 * fall;
    const double approach = std::pow(15 * mass * v * v / (16 * modulus * std::sqrt(0.01)), 0.4); // rigid plate
    const double hertz = 2.94328 * approach / v, coarse = 0.25; // one or two facets touch
    EXPECT_NEAR(found.contact, hertz, coarse * hertz);
}

TEST(SteelBall, LosesMostOfItsSpeedInFixedSteps) {
    EXPECT_LT(steel_ball({{"stages.fall.control.step_size", "fixed"}}).restitution, 0.8);
}

/// What each of the two keys is there for.
TEST(SteelBall, LosesLessWhereLessIsAllowed) {
    const Bounce coarse = steel_ball(
                     {{"stages.fall.control.closing_energy", "0.05"}, {"stages.fall.control.velocity_error", "0.1"}}),
                 fine = steel_ball({{"stages.fall.control.closing_energy", "1e-4"},
                                    {"stages.fall.control.velocity_error", "0.0005"},
                                    {"solver.smallest_step", "1e-5"}});
    EXPECT_LT(coarse.steps, fine.steps);
    EXPECT_LT(fine.closing, 0.1 * coarse.closing);
    EXPECT_GT(fine.restitution, 0.99);
}

/// Two equal bars of L = c = 1 that meet at 0.1 m/s touch for 2 L/c and trade their speeds, whatever the stage's step.
TEST(StepsOfTwoBars, TouchForTwiceTheWaveTimeInStepsThatTheDefaultsChoose) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("validation/two_bars.yaml"),
                       {{"bodies.left.mesh.block.divisions", "[40, 1, 1]"},
                        {"bodies.right.mesh.block.divisions", "[40, 1, 1]"},
                        {"stages.impact.steps", "6"}});
    double first = -1, last = 0, before = 0;
    for (const support::RunStep& step : run.steps) {
        if (step.pairs[0].normal > 0) {
            if (first < 0) first = before;
            last = step.time;
        }
        before = step.time;
    }
    const double element = 1. / 40;
    EXPECT_NEAR(first, 0.1, element);
    EXPECT_NEAR(last - first, 2, 6 * element);
    const support::RunStep& end = run.steps.back();
    double left = 0, right = 0;
    const linear::BlockMatrix& M = run.plan.model.consistent_mass;
    Field p(end.state.v.size());
    M.multiply_add(end.state.v, p, 1);
    for (Index i = 0; i < run.plan.model.nodes(); ++i)
        (i < run.plan.model.bodies[1].first_node ? left : right) += p[static_cast<std::size_t>(i)].x();
    const double momentum = 0.01 * 0.1;
    const double coarse = 0.1; // some twenty steps in all
    EXPECT_NEAR(right, momentum, coarse * momentum);
    EXPECT_NEAR(left, 0, coarse * momentum);
}

/// Ten falls of 10 mm, each contact as long as the first: a twentieth of the shipped scene's steps, which would each hold half a
/// contact.
TEST(TenBounces, ComeAtTheirTimesInStepsThatTheDefaultsChoose) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("validation/ten_bounces.yaml"), {{"stages.bounces.steps", "100"}});
    std::vector<double> touch, release;
    double before = 0;
    for (const support::RunStep& step : run.steps) {
        const bool touches = step.pairs[0].normal > 0;
        if (touches && touch.size() == release.size()) touch.push_back(before);
        if (!touches && touch.size() > release.size()) release.push_back(before);
        before = step.time;
    }
    ASSERT_GE(touch.size(), 9u);
    const double fall = std::sqrt(2 * 0.01 / 9.81), contact = release[0] - touch[0], bound = 0.045;
    for (std::size_t k = 0; k < touch.size(); ++k) {
        const double exact = fall + static_cast<double>(k) * (2 * fall + contact);
        EXPECT_NEAR(touch[k], exact, bound * exact) << "bounce " << k;
    }
    EXPECT_LT(-run.steps.back().ledger.contact, 0.06 * 0.016); // J: of the quarter's weight times where it fell from
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
