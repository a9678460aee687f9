/// What the tutorials promise, on their first part where they are long. The bouncing ball is in impact_test.

#include "support/scene_runner.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace osculate {
namespace {

/// Velocity of a body's centre of mass along x.
double velocity(const support::SceneRun& run, const char* name) {
    const model::Model& model = run.plan.model;
    const Field &v = run.steps.back().state.v, ones(v.size(), Vec3::UnitX());
    Field p(v.size()), m(v.size());
    model.consistent_mass.multiply_add(v, p, 1);
    model.consistent_mass.multiply_add(ones, m, 1);
    double momentum = 0, mass = 0;
    for (const model::Body& body : model.bodies)
        for (Index i = body.first_node; body.name == name && i < body.first_node + body.nodes(); ++i) {
            momentum += p[i].x();
            mass += m[i].x();
        }
    return momentum / mass;
}

TEST(Tutorials, BlockSlidesDownTheSlopeOrStays) {
    const double g = 10 / std::sqrt(1.25), down = 0.5 * g; // components of 10 m/s^2 on 1 : 2
    support::SceneRun slides, stays;
    support::run_scene(slides, support::shipped("tutorials/block_on_incline.yaml"));
    support::run_scene(stays, support::shipped("tutorials/block_on_incline.yaml"), {{"contact.sole.friction", "0.6"}});
    // it lets go once the hold, taken away within 0.05 s, is less than what friction leaves over
    const double start = 0.05 * 0.3 / 0.5, net = down - 0.3 * g;
    const double expected = net * (1 - 0.05) + 0.5 * net * (0.05 - start);
    EXPECT_NEAR(velocity(slides, "block"), expected, 0.01 * expected);
    EXPECT_LT(std::abs(velocity(stays, "block")), 1e-3);
}

TEST(Tutorials, BarsExchangeTheirVelocities) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("tutorials/two_bars.yaml"));
    // what remains is drawn out with the fronts of the waves, some elements of the sixty
    EXPECT_NEAR(velocity(run, "left"), 0, 0.03 * 10);
    EXPECT_NEAR(velocity(run, "right"), 10, 0.03 * 10);
}

TEST(Tutorials, RingIsBrakedByFrictionAlone) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("tutorials/ring_on_cylinder.yaml"),
                       {{"stages.spin.duration", "80 ms"}, {"stages.spin.steps", "40"}});
    const time::Ledger &first = run.steps.front().ledger, &last = run.steps.back().ledger;
    EXPECT_GT(last.friction, 0.3 * first.kinetic);
    EXPECT_LT(last.kinetic, 0.7 * first.kinetic);
    EXPECT_LT(std::abs(last.balance), 1e-6 * first.kinetic);
    EXPECT_LT(last.kinetic + last.strain + last.friction - last.external, 1.02 * first.kinetic);
}

TEST(Tutorials, PressedBlockStandsOnItsPressure) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("tutorials/press_block.yaml"));
    EXPECT_NEAR(run.steps.back().pairs[0].on_slave.z(), 1e5, 1) << "100 kPa on a square metre";
}

TEST(Tutorials, PulledBlockRubs) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("tutorials/pull_block.yaml"));
    const Vec3 force = run.steps.back().pairs[0].on_slave;
    EXPECT_NEAR(force.z(), 1e5, 1);
    // the block spreads sideways under its pressure as it slides: friction of a node that goes astray by an angle a falls
    // short of mu N along the pull by 1 - cos a, and by 1e-3 at 2.5 degrees
    EXPECT_LT(-force.x(), 0.3 * force.z() * (1 + 1e-9)) << "mu = 0.3, against the pull";
    EXPECT_GT(-force.x(), 0.3 * force.z() * (1 - 1e-3));
}

TEST(Tutorials, PadOfAFileLeavesAPrint) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("tutorials/pad_from_file.yaml"));
    const auto force = [&](std::size_t step) { return run.steps[step].pairs[0].on_slave.z(); };
    EXPECT_GT(force(0), 0);
    EXPECT_GT(force(3), 4 * force(0)) << "the contact grows with the depth";
}

TEST(Tutorials, StackStandsStillUnderItsWeights) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("tutorials/stack.yaml"));
    const model::State& end = run.steps.back().state;
    std::vector<double> carried;
    for (const model::ContactHistory& pair : end.contact) {
        double sum = 0;
        for (const Vec3& lambda : pair.lambda) sum += std::abs(lambda.z());
        if (sum > 0) carried.push_back(sum);
    }
    std::ranges::sort(carried);
    ASSERT_EQ(carried.size(), 10u);
    const double weight = 7850 * std::pow(50e-3, 3) * 9.81;
    for (std::size_t k = 0; k < carried.size(); ++k)
        EXPECT_NEAR(carried[k], static_cast<double>(k + 1) * weight, 1e-4 * weight) << k;
    for (const Vec3& v : end.v.values()) EXPECT_LT(v.norm(), 1e-6);
}

TEST(Tutorials, ToolIntoRubberHasHertzForceAndTheMomentOfFullSliding) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("tutorials/tool_into_rubber.yaml"));
    constexpr double E = 2e6, nu = 0.45, R = 0.06, d = 0.015, h = 0.08, mu = 0.4;
    constexpr double mesh = 0.1; // of 14 elements over the pad, and of strains of a half
    const double a = std::sqrt(R * d), chi = a / h;
    // Hertz on a thin layer that is bonded below, nu = 1/2 [Dimitriadis et al. 2002]
    const double layer = 1 + 1.133 * chi + 1.283 * chi * chi + 0.769 * std::pow(chi, 3) + 0.0975 * std::pow(chi, 4);
    const double hertz = 4. / 3 * E / (1 - nu * nu) * std::sqrt(R) * std::pow(d, 1.5) * layer;
    EXPECT_NEAR(-run.steps[4].pairs[0].on_slave.z(), hertz, mesh * hertz);
    const model::State& end = run.steps.back().state;
    const model::ContactHistory& tip = end.contact[0];
    double force = 0, moment = 0;
    for (std::size_t j = 0; j < tip.lambda.size(); ++j) {
        const auto node = static_cast<std::size_t>(tip.pair->slaves().node[j]);
        force -= tip.lambda[j].z();
        moment += (run.plan.model.X[node] + end.u[node]).cross(tip.lambda[j]).z();
    }
    // mu times Hertz' pressure times the radius, over the circle of that radius which carries the force
    const double radius = std::cbrt(0.75 * force * R * (1 - nu * nu) / E);
    const double sliding = 3 * std::numbers::pi / 16 * mu * force * radius;
    EXPECT_NEAR(moment, sliding, mesh * sliding);
}

/// When the front of a domino's top has moved by 4 mm, s; 0: never.
double knocked(const support::SceneRun& run, Index domino) {
    constexpr double far = 4e-3;
    const model::Body& body = run.plan.model.bodies[static_cast<std::size_t>(domino + 1)]; // the floor is first
    const auto begin = body.mesh.nodes.begin();
    const auto top = std::max_element(begin, body.mesh.nodes.end(),
                                      [](const Vec3& a, const Vec3& b) { return a.z() + a.x() < b.z() + b.x(); });
    const auto node = static_cast<std::size_t>(body.first_node + (top - begin));
    double time = 0, moved = 0;
    for (const auto& step : run.steps) {
        const double now = step.state.u[node].x();
        if (now >= far) return step.state.time - (step.state.time - time) * (now - far) / (now - moved);
        time = step.state.time;
        moved = now;
    }
    return 0;
}

TEST(Tutorials, DominoesFallAsRigidOnesDo) {
    // scripts/measure/dominoes --dt 2e-4: rigid bodies with friction and inelastic impacts, s
    const std::vector<double> rigid{0.0172, 0.1158, 0.1951, 0.2487};
    constexpr double allowed = 0.05;
    support::SceneRun run;
    support::run_scene(run, support::shipped("tutorials/dominoes.yaml"),
                       {{"stages.fall.duration", "0.26 s"}, {"stages.fall.steps", "260"}});
    for (std::size_t k = 0; k < rigid.size(); ++k)
        EXPECT_NEAR(knocked(run, static_cast<Index>(k)), rigid[k], allowed * rigid[k]) << k;
}

} // namespace
} // namespace osculate
