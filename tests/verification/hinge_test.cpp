/// The tutorial's frame of two bars against the truss of theory.

#include "support/scene_runner.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

constexpr double E = 210e9, A = 12e-3 * 10e-3, L = 0.1;
const double s = std::sin(8 * std::acos(-1.0) / 180);

/// Height of the hinge over that of the bars, under a force below the limit: F = E A (s^2 - y^2) y.
double height(double force) {
    double low = s / std::sqrt(3.0), high = s;
    for (int i = 0; i < 60; ++i) {
        const double y = (low + high) / 2;
        (E * A * (s * s - y * y) * y < force ? high : low) = y;
    }
    return low;
}

double sag(const support::RunStep& step, const model::Model& m) {
    const model::Set& eye = *std::ranges::find(m.sets, "left_eye", &model::Set::name);
    double sum = 0;
    for (const Index node : eye.nodes) sum -= step.state.u[node].y();
    return sum / static_cast<double>(eye.nodes.size());
}

TEST(Hinge, AFrameOnPinsSoftensAsATrussDoes) {
    // pins dent the ends of the bars: by a part of the bars' length that is that of the elements to the length
    double before = 1;
    for (const auto& [divisions, nodes] : {std::pair{"[20, 4, 1]", 23}, {"[40, 8, 1]", 43}}) {
        const double force = 0.9 * 2 * E * A * s * s * s / (3 * std::sqrt(3.0));
        support::SceneRun found;
        support::run_scene(
            found, support::shipped("tutorials/hinge.yaml"),
            {{"bodies.left.mesh.block.divisions", divisions},
             {"bodies.right.mesh.block.divisions", divisions},
             {"stages.push.nodal_force.left_eye", "[0 N, " + std::to_string(-force / nodes) + " N, 0 N]"}});
        const auto beyond = [&](const support::RunStep& step) {
            return sag(step, found.plan.model) / ((s - height(force * step.time)) * L) - 1;
        };
        EXPECT_GT(beyond(found.steps.front()), 0);
        EXPECT_LT(beyond(found.steps.front()), 0.02) << divisions;
        EXPECT_LT(beyond(found.steps.back()), 0.04) << divisions;
        EXPECT_LT(beyond(found.steps.back()), 0.5 * before) << divisions;
        before = beyond(found.steps.back());
        // both bars, and the hinge on its line
        const model::Set& other = *std::ranges::find(found.plan.model.sets, "right_eye", &model::Set::name);
        Vec3 mean = Vec3::Zero();
        for (const Index node : other.nodes) mean += found.steps.back().state.u[node] / static_cast<double>(nodes);
        EXPECT_NEAR(mean.y(), -sag(found.steps.back(), found.plan.model), 1e-12);
        EXPECT_NEAR(mean.x(), 0, 1e-9);
    }
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
