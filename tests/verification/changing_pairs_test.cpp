/// Stages that change the friction of pairs, and put them out of force.

#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace osculate {
namespace {

const std::string sledge = R"(
bodies:
  ground:
    mesh: {block: {size: [4 m, 1 m, 1 m], divisions: [8, 2, 2]}}
    material: {linear_elastic: {E: 30 MPa, nu: 0.2}}
  sledge:
    mesh: {block: {origin: [0.5 m, 0 m, 1 m], size: [1 m, 1 m, 0.5 m], divisions: [3, 3, 2]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0.3}}
sets:
  bed: {body: ground, surface: z_min}
  face: {body: ground, surface: z_max}
  under: {body: sledge, surface: z_min}
  top: {body: sledge, surface: z_max}
supports:
  bed: {fix: [x, y, z]}
contact:
  touch: {slave: under, master: {set: face, surface: facets}, friction: 0.3}
stages:
  press: {steps: 1, displacement: {top: {x: 0 m, y: 0 m, z: -1 mm}}}
  rough: {steps: 4, displacement: {top: {x: 0.2 m, y: 0 m, z: -1 mm}}}
  smooth: {steps: 4, displacement: {top: {x: 0.4 m, y: 0 m, z: -1 mm}}, friction: {touch: 0.1}}
  apart: {steps: 1, displacement: {top: {x: 0.4 m, y: 0 m, z: -100 mm}}, pairs: {touch: false}}
  back: {steps: 1, displacement: {top: {x: 0.4 m, y: 0 m, z: -1 mm}}}
  again: {steps: 4, displacement: {top: {x: 0.6 m, y: 0 m, z: -1 mm}}, pairs: {touch: true}}
)";

const support::RunStep& end_of(const support::SceneRun& run, double time) {
    const auto at =
        std::ranges::find_if(run.steps, [&](const support::RunStep& s) { return std::abs(s.time - time) < 1e-9; });
    EXPECT_NE(at, run.steps.end());
    return *at;
}

TEST(ChangingPairs, RubAsTheStageSays) {
    support::SceneRun run;
    support::run_scene(run, support::scene_file("sledge.yaml", sledge));
    const auto ratio = [&](double time) {
        const support::PairForces& forces = end_of(run, time).pairs[0];
        return forces.friction / forces.normal;
    };
    EXPECT_NEAR(ratio(2), 0.3, 1e-9);
    EXPECT_NEAR(ratio(3), 0.1, 1e-9);
    EXPECT_NEAR(ratio(6), 0.1, 1e-9) << "it stays until a stage changes it again";
}

TEST(ChangingPairs, LetBodiesThroughWhereTheyAreNotInForce) {
    support::SceneRun run;
    support::run_scene(run, support::scene_file("sledge.yaml", sledge));
    for (const double time : {4.0, 5.0}) {
        const support::RunStep& step = end_of(run, time);
        EXPECT_EQ(step.pairs[0].on_slave.norm(), 0) << time;
        const Index deep = run.plan.model.bodies[1].first_node;
        EXPECT_LT(std::abs(step.state.u[deep].z() - (time == 4 ? -0.1 : -1e-3)), 1e-12) << "the sledge is not deformed";
    }
    EXPECT_NEAR(end_of(run, 6).pairs[0].on_slave.z() / end_of(run, 2).pairs[0].on_slave.z(), 1, 1e-2);
}

} // namespace
} // namespace osculate
