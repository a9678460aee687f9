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
    const std::string more = little + R"(
  hold: {}
  shake: {duration: 10 ms, analysis: {dynamic: {mass: lumped}}}
  sway:
    duration: 10 ms
    analysis: {dynamic: {mass: consistent}}
    pressure: {top: {table: [[0 s, 10 kPa], [10 ms, 0 kPa]]}}
gravity: [0, 0, -10 m/s^2]
)";
    const scene::Scene scene = scene::parse_scene(more, "scene.yaml");
    Timings timings;
    const Plan plan = compile(scene, build_meshes(scene), 1, timings);
    const time::Stage &press = plan.stages[0], &hold = plan.stages[1], &shake = plan.stages[2], &sway = plan.stages[3];
    const auto count = [](const SparseField& field) { return std::distance(field.begin(), field.end()); };
    constexpr std::ptrdiff_t on_top = 16;
    EXPECT_EQ(count(press.force_start), 0);
    EXPECT_EQ(count(press.force_end), on_top);
    EXPECT_EQ(count(hold.force_start), on_top);
    ASSERT_EQ(sway.course_forces.size(), 1U);
    EXPECT_EQ(count(sway.course_forces[0].pattern), on_top);
    EXPECT_TRUE(press.weight == hold.weight && hold.weight == shake.weight) << "statics weigh what will move next";
    EXPECT_NE(*sway.weight, *shake.weight) << "of another mass matrix";
    const auto sum = [&](const time::Stage& stage, double part) {
        Vec3 force = Vec3::Zero();
        for (const Vec3& f : stage.force(plan.model.X.size(), part)) force += f;
        return force.z();
    };
    constexpr double pressed = 10e3, weight = 2.5 * 1000 * 10, round_off = 1e-9 * (pressed + weight); // N
    EXPECT_NEAR(sum(press, 0.25), -0.25 * pressed - weight, round_off) << "weight is there from the start";
    EXPECT_NEAR(sum(hold, 0.5), -pressed - weight, round_off);
    EXPECT_NEAR(sum(sway, 1), -weight, round_off);
}

} // namespace
} // namespace osculate::app::OSCULATE_THIS_FILE
