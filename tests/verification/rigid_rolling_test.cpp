/// A rigid ball on an elastic layer: it rolls down an incline at 5/7 of the acceleration, and one that slides ends up
/// rolling at 5/7 of its speed.

#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

constexpr double weight = 80, mass = 8, radius = 0.1; // N across the layer, kg, m

std::string ball_on_layer(double E, double friction, double speed, const std::string& stages) {
    return R"(
bodies:
  layer:
    mesh: {block: {origin: [-0.05 m, -0.03 m, -0.02 m], size: [0.36 m, 0.06 m, 0.02 m], divisions: [36, 6, 1]}}
    material: {linear_elastic: {E: )" +
           std::to_string(E) + R"(, nu: 0, density: 100}}
  ball:
    mesh: {ball: {radius: 0.1 m, divisions: [8, 2, 8]}, translate: [0, 0, 0.1]}
    rigid: {mass: 8 kg, centre: [0, 0, 0.1], inertia: [0.032, 0.032, 0.032]}
    initial_velocity: [)" +
           std::to_string(speed) + R"(, 0, 0]
sets:
  bottom: {body: layer, surface: z_min}
  top: {body: layer, surface: z_max}
  sphere: {body: ball, surface: outer}
supports:
  bottom: {fix: [x, y, z]}
contact:
  touch: {slave: top, master: {set: sphere}, friction: )" +
           std::to_string(friction) + "}\nstages:\n" + stages;
}

std::string stage(const std::string& name, double duration, int steps, const std::string& ramp, double along) {
    return "  " + name + R"(:
    analysis: {dynamic: {integrator: {generalised_alpha: {rho_inf: 0.5}}}}
    ramp: )" +
           ramp + "\n    duration: " + std::to_string(duration) + "\n    steps: " + std::to_string(steps) +
           "\n    force: {ball: [" + std::to_string(along) + ", 0, " + std::to_string(-weight) + "]}\n";
}

TEST(RigidBall, RollsDownAnInclineAtFiveSevenths) {
    constexpr double along = 28; // N: an incline of 19 degrees
    support::SceneRun run;
    support::run_scene(run,
                       support::scene_file("roll.yaml", ball_on_layer(1e6, 0.5, 0,
                                                                      stage("settle", 0.1, 40, "linear", 0) +
                                                                          stage("roll", 0.125, 50, "step", along))));
    const support::RunStep &start = run.steps[run.steps.size() - 51], &end = run.steps.back();
    ASSERT_NEAR(start.time, 0.1, 1e-9);
    const Vec3 gained = end.state.rigid[0].velocity - start.state.rigid[0].velocity;
    constexpr double tolerance = 0.01; // the layer gives way, and the ball bounces a little
    EXPECT_NEAR(gained.x(), 5. / 7 * along / mass * 0.125, tolerance * gained.x());
    const double spin = model::spin(end.state.rigid[0]).y();
    EXPECT_NEAR(radius * spin, end.state.rigid[0].velocity.x(), 0.03 * gained.x()); // it sinks in by 2 % of the radius
}

TEST(RigidBall, ThatSlidesEndsUpRollingAtFiveSevenths) {
    constexpr double speed = 1;
    support::SceneRun run;
    support::run_scene(
        run, support::scene_file("slide.yaml", ball_on_layer(4e6, 0.25, speed, stage("slide", 0.16, 128, "step", 0))));
    const model::RigidMotion& end = run.steps.back().state.rigid[0];
    EXPECT_NEAR(end.velocity.x(), 5. / 7 * speed, 0.01 * speed);
    EXPECT_NEAR(radius * model::spin(end).y(), 5. / 7 * speed, 0.02 * speed);
    // friction took 2/7 of the energy
    EXPECT_NEAR(run.steps.back().ledger.friction, 2. / 7 * mass * speed * speed / 2, 0.03 * mass * speed * speed / 2);
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
