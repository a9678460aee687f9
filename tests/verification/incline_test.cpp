/// A block on a slope.

#include "support/scene_runner.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace osculate {
namespace {

/// Mean displacement of the block down the slope at every accepted time.
std::vector<std::pair<double, double>> descent(double mu) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("validation/incline.yaml"),
                       {{"contact.sole.friction", std::to_string(mu)}});
    const model::Body& block = run.plan.model.bodies[1];
    std::vector<std::pair<double, double>> result{{0, 0}};
    for (const support::RunStep& step : run.steps) {
        double sum = 0;
        for (Index i = 0; i < block.nodes(); ++i) sum += step.state.u[block.first_node + i].x();
        result.emplace_back(step.time, sum / block.nodes());
    }
    return result;
}

double at(const std::vector<std::pair<double, double>>& path, double time) {
    return std::min_element(
               path.begin(), path.end(),
               [&](const auto& a, const auto& b) { return std::abs(a.first - time) < std::abs(b.first - time); })
        ->second;
}

TEST(Incline, SlidesJustBelowTheAngleOfFriction) {
    const auto path = descent(0.49);
    const double acceleration = (at(path, 1) - 2 * at(path, 0.5) + at(path, 0)) / 0.25;
    const double exact = 10 * (0.5 - 0.49) / std::sqrt(1.25);
    EXPECT_NEAR(acceleration, exact, 0.02 * exact); // gravity comes suddenly: the blocks ring while it starts
}

TEST(Incline, SticksJustAboveIt) {
    const auto path = descent(0.51);
    EXPECT_LT(std::abs(at(path, 1) - at(path, 0.8)), 1e-6); // at rest once the ringing has died
}

} // namespace
} // namespace osculate
