/// Bodies without contact: the Cholesky path against exact solutions.

#include "osculate/output/vtk_file.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

using support::scene_file;

const std::string block = R"(
bodies:
  bar:
    mesh: {block: {origin: [0, 0, 0], size: [2 m, 1 m, 1 m], divisions: [4, 3, 2]}}
    material: {linear_elastic: {E: 200 GPa, nu: 0.3}}
sets:
  left: {body: bar, surface: x_min}
  right: {body: bar, surface: x_max}
  front: {body: bar, surface: y_min}
  bottom: {body: bar, surface: z_min}
supports:
  left: {fix: [x]}
  front: {symmetry: [0, 1, 0]}
  bottom: {fix: [z]}
)";

TEST(Bar, StretchesByHookesLaw) {
    support::SceneRun run;
    support::run_scene(run,
                       scene_file("bar.yaml", block + "stages: {pull: {steps: 2, pressure: {right: -100 MPa}}}\n"));
    ASSERT_EQ(run.steps.size(), 2u);
    const double strain = 100e6 / 200e9;
    for (std::size_t i = 0; i < run.plan.model.X.size(); ++i) {
        const Vec3 X = run.plan.model.X[i];
        const Vec3 exact(strain * X.x(), -0.3 * strain * X.y(), -0.3 * strain * X.z());
        EXPECT_LT((run.steps[1].state.u[i] - exact).norm(), 1e-11 * strain * 2);     // round-off of the factorisation
        EXPECT_LT((run.steps[0].state.u[i] - exact / 2).norm(), 1e-11 * strain * 2); // half the load at half the stage
    }
    EXPECT_NEAR(run.steps[1].reactions[0].x(), -100e6, 1e-9 * 100e6); // 1 m^2
}

TEST(Bar, IsFactorisedOnceForAllSteps) {
    const scene::Scene scene =
        scene::read_scene(scene_file("bar10.yaml", block + "stages: {pull: {steps: 10, pressure: {right: 1 MPa}}}\n"));
    Timings timings;
    app::Plan plan = app::compile(scene, app::build_meshes(scene), 1, timings);
    time::Stepper stepper(plan.model, plan.stages, plan.stepper, timings);
    struct Silent final : time::StepObserver {
        void attempted(const time::Attempt&, const std::vector<equilibrium::IterationRecord>&) override {}
        void accepted(const time::AcceptedStep& step) override { EXPECT_EQ(step.iterations, 1); }
    } observer;
    stepper.run(observer);
    EXPECT_EQ(stepper.counts().factorisations, 1);
}

TEST(Bar, HangsUnderItsWeight) {
    // u = b (L x - x^2/2) / E at nu = 0, which trilinear elements reproduce at their nodes
    support::SceneRun run;
    support::run_scene(run,
                       scene_file("weight.yaml", block + "stages: {hang: {body_force: {bar: [80 kN/m^3, 0, 0]}}}\n"),
                       {{"bodies.bar.material.linear_elastic.nu", "0"}});
    for (std::size_t i = 0; i < run.plan.model.X.size(); ++i) {
        const double x = run.plan.model.X[i].x(), exact = 80e3 * (2 * x - x * x / 2) / 200e9;
        EXPECT_NEAR(run.steps[0].state.u[i].x(), exact, 1e-11 * 80e3 * 2 / 200e9);
    }
}

TEST(Bar, ReadFromAFileIsTheSameBar) {
    const std::string path = scene_file("generated.yaml", block + "stages: {pull: {pressure: {right: -100 MPa}}}\n");
    support::SceneRun generated, read;
    support::run_scene(generated, path);
    const mesh::Mesh& mesh = generated.plan.model.bodies[0].mesh;
    const std::string file = support::temporary("bar.vtu");
    output::write_vtu(file, mesh.nodes, mesh.blocks, {}, 0);
    support::run_scene(read, path,
                       {{"bodies.bar.mesh", "{file: {path: '" + file + "'}}"},
                        {"sets.left", "{body: bar, plane: {point: [0, 0, 0], normal: [1, 0, 0]}}"},
                        {"sets.right", "{body: bar, box: {min: [2, 0, 0], max: [2, 1, 1]}}"},
                        {"sets.front", "{body: bar, normal: {direction: [0, -1, 0], angle: 0.1}}"},
                        {"sets.bottom", "{body: bar, plane: {point: [0, 0, 0], normal: [0, 0, 1]}}"}});
    for (std::size_t i = 0; i < generated.plan.model.X.size(); ++i)
        EXPECT_EQ(generated.steps[0].state.u[i], read.steps[0].state.u[i]);
}

TEST(Bar, FollowsADrivenFaceThroughStages) {
    // held at its last value where a later stage does not name it
    support::SceneRun run;
    support::run_scene(run, scene_file("driven.yaml", block + R"(
stages:
  pull: {steps: 2, displacement: {right: {x: 2 mm}}}
  wait: {steps: 1, body_force: {bar: [0, 0, 0]}}
  back: {steps: 4, displacement: {right: {x: 0 mm}}}
)"));
    const std::vector<double> expected{1e-3, 2e-3, 2e-3, 1.5e-3, 1e-3, 0.5e-3, 0};
    ASSERT_EQ(run.steps.size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k)
        for (std::size_t i = 0; i < run.plan.model.X.size(); ++i)
            EXPECT_NEAR(run.steps[k].state.u[i].x(), expected[k] * run.plan.model.X[i].x() / 2, 1e-14);
}

TEST(Bar, DoesNotCareAboutSkewedSupports) {
    // the same bar turned in space with its supports
    support::SceneRun straight, turned;
    const std::string path = scene_file("skew.yaml", block + "stages: {pull: {pressure: {right: -100 MPa}}}\n");
    support::run_scene(straight, path);
    const Mat3 R = Eigen::AngleAxisd(0.5, Vec3(1, -1, 2).normalized()).toRotationMatrix();
    const auto vector = [](const Vec3& v) {
        char text[120];
        std::snprintf(text, sizeof text, "[%.17g, %.17g, %.17g]", v.x(), v.y(), v.z());
        return std::string(text);
    };
    const std::string axes = "{fix: [KEY], axes: [" + vector(R.col(0)) + ", " + vector(R.col(1)) + "]}";
    const auto with = [&](const char* key) {
        std::string text = axes;
        return text.replace(text.find("KEY"), 3, key);
    };
    support::run_scene(turned, path,
                       {{"bodies.bar.mesh.rotate", "{axis: [1, -1, 2], angle: 0.5 rad}"},
                        {"supports.left", with("x")},
                        {"supports.front", "{symmetry: " + vector(R.col(1)) + "}"},
                        {"supports.bottom", with("z")}});
    for (std::size_t i = 0; i < straight.plan.model.X.size(); ++i)
        EXPECT_LT((turned.steps[0].state.u[i] - R * straight.steps[0].state.u[i]).norm(), 1e-12);
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
