/// A scene that asks for little: nothing is made of what it leaves out.

#include "osculate/app/compile.hpp"
#include "osculate/scene/reader.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <memory>

namespace osculate::app::OSCULATE_THIS_FILE {
namespace {

/// Static, linear, facets, no friction.
const std::string little = R"(
bodies:
  base:
    mesh: {block: {size: [2 m, 2 m, 0.5 m], divisions: [4, 4, 1]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0.3, density: 1000 kg/m^3}}
  cap:
    mesh: {block: {origin: [0.5 m, 0.5 m, 0.5 m], size: [1 m, 1 m, 0.5 m], divisions: [3, 3, 1]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0.3, density: 1000 kg/m^3}}
    initial_velocity: [0, 0, -1 m/s]
sets:
  bed: {body: base, surface: z_min}
  ground: {body: base, surface: z_max}
  under: {body: cap, surface: z_min}
  top: {body: cap, surface: z_max}
supports:
  bed: {fix: [x, y, z]}
  top: {fix: [x, y]}
contact:
  joint: {slave: under, master: {set: ground, surface: facets}}
stages:
  press: {steps: 3, pressure: {top: 10 kPa}}
)";

struct LittleRun final : time::StepObserver {
    LittleRun() {
        const scene::Scene scene = scene::parse_scene(little, "scene.yaml");
        plan = compile(scene, build_meshes(scene), 1, timings);
        stepper = std::make_unique<time::Stepper>(plan.model, plan.stages, plan.stepper, timings);
    }
    void attempted(const time::Attempt&, const std::vector<equilibrium::IterationRecord>&) override {}
    void accepted(const time::AcceptedStep& step) override {
        ++steps;
        EXPECT_EQ(step.ledger, nullptr);
        EXPECT_TRUE(step.state.v.empty());
        EXPECT_TRUE(step.state.a.empty());
        const equilibrium::BodyForces& bodies = step.equilibrium.bodies();
        EXPECT_FALSE(bodies.dynamic());
        EXPECT_FALSE(bodies.stabilised());
        EXPECT_EQ(&bodies.tangent(), &plan.model.K) << "the stiffness itself, no copy";
        EXPECT_TRUE(bodies.outer_forces(step.state).empty());
        look(step.equilibrium.contact()[0]);
    }
    /// From where the step began every slave node has moved.
    static void look(const model::ContactEvaluation& evaluation) {
        contact::ContactVariation variation;
        Matrix dd;
        for (Index j = 0; j < evaluation.pair().size(); ++j) {
            ASSERT_TRUE(evaluation.point(j).found);
            EXPECT_EQ(evaluation.point(j).trace, nullptr) << "kept by smooth surfaces alone";
            EXPECT_FALSE(evaluation.drift(j).isZero(0));
            EXPECT_TRUE(evaluation.state(j, Vec3::Zero()).drift.isZero(0)) << "of no concern without friction";
            evaluation.vary(j, variation);
            evaluation.drift_variation(j, variation, dd);
            EXPECT_TRUE(dd.isZero(0));
        }
    }
    Timings timings;
    Plan plan;
    std::unique_ptr<time::Stepper> stepper;
    int steps = 0;
};

TEST(LeaveOut, NothingIsCompiledThatTheSceneDoesNotAskFor) {
    const Plan plan = LittleRun().plan;
    const model::Model& model = plan.model;
    EXPECT_EQ(model.nonlinear, nullptr);
    EXPECT_TRUE(model.consistent_mass.empty());
    EXPECT_TRUE(model.lumped_mass.empty());
    EXPECT_TRUE(model.initial_velocity.empty()) << "nothing moves in statics, whatever the body says";
    ASSERT_EQ(plan.stages.size(), 1U);
    const time::Stage& stage = plan.stages[0];
    EXPECT_FALSE(stage.dynamics);
    EXPECT_FALSE(stage.follow_paths);
    EXPECT_TRUE(stage.limits.usual_bound) << "no trial solves where steps are easy";
    EXPECT_TRUE(stage.courses.empty() && stage.course_forces.empty() && stage.follower_pressures.empty());

    ASSERT_EQ(model.pairs.size(), 1U);
    const model::ContactPair& pair = *model.pairs[0];
    EXPECT_FALSE(pair.master()->refits());
    for (Index f = 0; f < pair.surface().facet_count(); ++f) {
        EXPECT_TRUE(std::ranges::equal(pair.master()->patch_vertices(f), pair.surface().facet_vertices(f)))
            << "a facet, no patch";
        EXPECT_TRUE(std::isinf(pair.thickness(f))) << "asked for by the collision check alone";
    }
    EXPECT_FALSE(pair.mirrored());
    EXPECT_TRUE(pair.slaves().in_plane.empty());
}

TEST(LeaveOut, NothingIsMadeWhileItRuns) {
    LittleRun run;
    run.stepper->run(run);
    EXPECT_EQ(run.steps, 3);
    EXPECT_EQ(run.stepper->counts().paths_followed, 0);
    EXPECT_EQ(run.stepper->counts().refreshed_patches, 0);
    EXPECT_EQ(run.stepper->counts().stabilised_steps, 0);
}

TEST(LeaveOut, StagesHoldForcesWhereThereAreAnyAndShareTheirWeight) {
    const std::string more = little + "  hold: {}\n  shake: {analysis: dynamic, duration: 10 ms}\n  rest: {}\n"
                                      "gravity: [0, 0, -9.81 m/s^2]\n";
    const scene::Scene scene = scene::parse_scene(more, "scene.yaml");
    Timings timings;
    const Plan plan = compile(scene, build_meshes(scene), 1, timings);
    constexpr std::ptrdiff_t on_top = 16;
    for (const time::Stage& stage : plan.stages)
        EXPECT_EQ(std::distance(stage.force_end.begin(), stage.force_end.end()), on_top) << stage.name;
    EXPECT_TRUE(plan.stages[0].force_start.empty());
    EXPECT_EQ(plan.stages[0].weight, plan.stages[1].weight);
    Vec3 force = Vec3::Zero();
    for (const Vec3& f : plan.stages[1].force(plan.model.X.size(), 0.5)) force += f;
    EXPECT_NEAR(force.z(), -10e3 - 2500 * 9.81, 1e-9 * 35e3) << "pressure and weight of 2.5 m^3";
}

} // namespace
} // namespace osculate::app::OSCULATE_THIS_FILE
