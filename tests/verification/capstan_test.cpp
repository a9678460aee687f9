/// A strap half around a drum: friction that adds up over an arc must obey Euler's and Eytelwein's law.

#include "support/scene_runner.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

/// configs/validation/capstan.yaml, in as few steps as a user would take
TEST(Capstan, MultipliesTheForceByTheExponentialOfFrictionTimesAngle) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("validation/capstan.yaml"),
                       {{"stages.tighten.steps", "2"}, {"stages.draw.steps", "2"}});
    const auto set = std::ranges::find_if(run.plan.constrained_sets, [&](Index s) {
        return run.plan.model.sets[static_cast<std::size_t>(s)].name == "drawn";
    });
    ASSERT_NE(set, run.plan.constrained_sets.end());
    ASSERT_EQ(run.steps.size(), 4u);
    const auto drawn_by = [&](std::size_t step) {
        return -run.steps[step].reactions[static_cast<std::size_t>(set - run.plan.constrained_sets.begin())].x();
    };
    // a moment about the axis is T times the radius of the strap's middle, that of friction times the one of its inner face
    const double load = 10, friction = 0.25, radius = 50, thickness = 1, thin = std::exp(friction * std::numbers::pi),
                 thick = std::exp(friction * std::numbers::pi * radius / (radius + thickness / 2));
    constexpr double bent = 0.005; // by the stiffness of the strap in bending, at the ends of the arc
    // the load draws the strap towards itself, as far as it stretches
    EXPECT_GT(drawn_by(1), load / thin * (1 - bent));
    EXPECT_LT(drawn_by(1), load / thick * (1 + bent));
    for (const std::size_t step : {2, 3}) {
        EXPECT_GT(drawn_by(step), load * thick * (1 - bent));
        EXPECT_LT(drawn_by(step), load * thin * (1 + bent));
    }
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
