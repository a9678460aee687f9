/// Stages that change the friction of pairs, put them out of force, and let go of what was held.

#include "osculate/core/error.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <algorithm>
#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
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

const std::string bar = R"(
bodies:
  bar:
    mesh: {block: {size: [4 m, 1 m, 1 m], divisions: [4, 2, 2]}}
    material: {neo_hookean: {E: 10 MPa, nu: 0.3}}
sets:
  left: {body: bar, surface: x_min}
  right: {body: bar, surface: x_max}
  side: {body: bar, surface: y_min}
  floor: {body: bar, surface: z_min}
supports:
  left: {fix: [x, y, z]}
  floor: {fix: [z]}
stages:
  stretch: {steps: 2, displacement: {right: {x: 0.2 m, y: 0.1 m}}}
  slide: {steps: 1, release: {right: [y]}}
  let_go: {steps: 2, release: {right: [x], left: [y, z]}, displacement: {floor: {y: 0 m}}}
  pull: {steps: 2, displacement: {right: {x: 0.1 m}}}
)";

TEST(Release, LetsGoOfWhatWasHeldOrDriven) {
    support::SceneRun run;
    support::run_scene(run, support::scene_file("bar.yaml", bar));
    const model::Model& m = run.plan.model;
    const auto set = [&](const char* name) { return *std::ranges::find(m.sets, name, &model::Set::name); };
    const auto largest = [&](double time, const model::Set& nodes, int k) {
        double u = 0;
        for (const Index node : nodes.nodes) u = std::max(u, std::abs(end_of(run, time).state.u[node](k)));
        return u;
    };
    EXPECT_NEAR(largest(1, set("right"), 1), 0.1, 1e-12);
    EXPECT_NEAR(largest(2, set("right"), 0), 0.2, 1e-12) << "only y is free";
    EXPECT_LT(largest(2, set("right"), 1), 0.05);
    for (const char* name : {"left", "right"})
        for (int k = 0; k < 3; ++k) EXPECT_LT(largest(3, set(name), k), 1e-7) << name << k << ": nothing pulls";
    EXPECT_NEAR(largest(4, set("right"), 0), 0.1, 1e-12) << "driven again";
    EXPECT_GT(largest(4, set("left"), 1), 1e-4) << "free to narrow";
    EXPECT_LT(largest(4, set("left"), 0), 1e-15);
}

TEST(Release, IsRefusedWhereOtherThingsHang) {
    const auto faults = [&](const std::vector<scene::Override>& overrides) {
        std::string all;
        try {
            support::SceneRun run;
            support::run_scene(run, support::scene_file("bar.yaml", bar), overrides);
        } catch (const SceneError& error) {
            for (const Fault& fault : error.faults())
                all += fault.key + ": " + fault.expected + "; " + fault.found + "\n";
        }
        return all;
    };
    using testing::HasSubstr;
    EXPECT_THAT(faults({{"supports.right", "{symmetry: [1, 0, 0]}"}, {"stages.stretch", "{steps: 1}"}}),
                HasSubstr("no plane of symmetry"));
    EXPECT_THAT(faults({{"stages.slide.displacement", "{right: {y: 0 m}}"}}),
                HasSubstr("components that this stage does not drive; y"));
    EXPECT_THAT(faults({{"stages.slide.release", "{right: [z]}"}}), HasSubstr("z, which is free"));
    EXPECT_THAT(faults({{"stages.let_go.release", "{right: [x, y]}"}}), HasSubstr("y, which is free"))
        << "let go before";
    EXPECT_THAT(faults({{"couplings", "{hand: {set: right}}"},
                        {"supports", "{left: {fix: [x, y, z]}}"},
                        {"stages", "{slide: {steps: 1, release: {right: [y]}}}"}}),
                HasSubstr("stages.slide.release.right: nodes that follow no others"));
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
} // namespace osculate::OSCULATE_THIS_FILE
