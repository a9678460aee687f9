/// Implicit dynamics against exact solutions of bars.

#include "support/scene_runner.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <numbers>

namespace osculate {
namespace {

constexpr double pi = std::numbers::pi;

std::string scene_file(const std::string& name, const std::string& text) {
    const std::string path = testing::TempDir() + name;
    std::ofstream(path) << text;
    return path;
}

/// A bar clamped at its right end, compressed by 0.1 Pa and let go. L = E = density = 1, nu = 0: wave speed 1, period 4.
std::string free_bar(const std::string& analysis, int steps) {
    return R"(
bodies:
  bar:
    mesh: {block: {size: [1 m, 0.1 m, 0.1 m], divisions: [20, 1, 1]}}
    material: {linear_elastic: {E: 1 Pa, nu: 0, density: 1 kg/m^3}}
sets:
  clamped: {body: bar, surface: x_max}
  tip: {body: bar, surface: x_min}
supports:
  clamped: {fix: [x, y, z]}
stages:
  compress: {pressure: {tip: 0.1 Pa}}
  swing:
    analysis: {dynamic: )" +
           analysis + R"(}
    duration: 4 s
    steps: )" +
           std::to_string(steps) + R"(
    ramp: step
    pressure: {tip: 0 Pa}
)";
}

const support::RunStep& last(const support::SceneRun& run) {
    return run.steps.back();
}

double energy(const support::RunStep& step) {
    return step.ledger.kinetic + step.ledger.strain;
}

TEST(FreeBar, KeepsItsEnergyWithNewmark) {
    for (const char* mass : {"consistent", "lumped"}) {
        support::SceneRun run;
        support::run_scene(
            run, scene_file("bar.yaml", free_bar(std::string("{integrator: {newmark: {}}, mass: ") + mass + "}", 200)));
        const double E0 = 0.5 * 0.1 * 0.1 * 0.01; // sigma^2 V / 2 E
        const double round_off = 1e-10;           // of factorisations and 200 steps
        for (std::size_t k = 1; k < run.steps.size(); ++k) {
            ASSERT_NEAR(energy(run.steps[k]), E0, round_off * E0);
            ASSERT_NEAR(run.steps[k].ledger.balance, 0, round_off * E0);
            ASSERT_NEAR(run.steps[k].ledger.algorithmic, 0, round_off * E0);
        }
    }
}

/// Displacement of the tip after `time` of the swing, from the same mesh in ever smaller steps.
double tip(const std::string& analysis, int steps) {
    support::SceneRun run;
    support::run_scene(run, scene_file("bar.yaml", free_bar(analysis, steps)));
    return last(run).state.u[0].x();
}

/// Errors at time 4, with a bar soft enough for its steps: only the first modes matter, damped by stiffness.
TEST(FreeBar, ConvergesInTimeAtTheOrderOfTheIntegrator) {
    struct Case {
        const char* integrator;
        double order;
    };
    const std::string damping = ", stiffness_damping: 0.2 s, mass_damping: 0.1 Hz}";
    const double exact = tip("{integrator: {newmark: {}}" + damping, 12800);
    for (const Case& c : {Case{"{newmark: {}}", 2}, Case{"{generalised_alpha: {rho_inf: 0.5}}", 2},
                          Case{"{hht: {alpha: -0.2}}", 2}, Case{"{backward_euler: {}}", 1}}) {
        const std::string analysis = std::string("{integrator: ") + c.integrator + damping;
        const double coarse = std::abs(tip(analysis, 200) - exact), fine = std::abs(tip(analysis, 400) - exact);
        const double slack = 0.15; // of a slope measured between two steps
        EXPECT_NEAR(std::log2(coarse / fine), c.order, slack) << c.integrator;
    }
}

TEST(FreeBar, SwingsWithThePeriodOfItsLength) {
    support::SceneRun run;
    support::run_scene(run, scene_file("bar.yaml", free_bar("{integrator: {newmark: {}}}", 400)));
    const double first_mode = 0.1 * 8 / (pi * pi);
    EXPECT_NEAR(run.steps[0].state.u[0].x(), 0.1, 1e-9);
    double largest = 0, at = 0;
    for (std::size_t k = 300; k < run.steps.size(); ++k)
        if (run.steps[k].state.u[0].x() > largest) {
            largest = run.steps[k].state.u[0].x();
            at = run.steps[k].time - 1;
        }
    EXPECT_NEAR(at, 4, 0.05); // one element: where the mesh can draw the top of the triangle wave
    EXPECT_GT(largest, first_mode);
}

TEST(FlyingBody, KeepsItsMomentaAndFallsAsGravitySays) {
    const std::string text = R"(
bodies:
  brick:
    mesh: {block: {size: [1 m, 2 m, 3 m], divisions: [1, 2, 2]}}
    material: {linear_elastic: {E: 1 GPa, nu: 0.3, density: 1000 kg/m^3}}
    initial_velocity: [3 m/s, 0 m/s, 4 m/s]
gravity: [0 m/s^2, 0 m/s^2, -10 m/s^2]
stages:
  flight: {analysis: dynamic, duration: 1 s, steps: 10}
)";
    support::SceneRun run;
    support::run_scene(run, scene_file("brick.yaml", text));
    const double mass = 6000, round_off = 1e-9;
    for (const support::RunStep& step : run.steps) {
        const double t = step.time;
        EXPECT_NEAR(step.ledger.linear.x(), 3 * mass, round_off * mass);
        EXPECT_NEAR(step.ledger.linear.z(), (4 - 10 * t) * mass, round_off * mass * 10);
        for (const Vec3& u : step.state.u) EXPECT_LT((u - Vec3(3 * t, 0, 4 * t - 5 * t * t)).norm(), round_off);
        EXPECT_NEAR(step.ledger.balance, 0, round_off * mass);
    }
}

/// A bar of one element, E = density = 1, nu = 0: its free end swings as 0.1 cos(sqrt(3) t).
std::string one_element(const std::string& control, const std::string& damping = "") {
    std::string text = free_bar("{integrator: {generalised_alpha: {rho_inf: 0.8}}" + damping + "}", 1);
    text.replace(text.find("[20, 1, 1]"), 10, "[1, 1, 1]");
    return text + "    control: {error_tolerance: " + control + "}\n";
}

TEST(TimeError, FollowsItsTolerance) {
    const double w = std::sqrt(3.), T = 4;
    std::vector<double> errors;
    for (const char* tolerance : {"1e-5 m", "1e-7 m"}) {
        support::SceneRun run;
        support::run_scene(run, scene_file("one_element.yaml", one_element(tolerance)));
        const model::State& end = last(run).state;
        errors.push_back(std::hypot(end.u[0].x() - 0.1 * std::cos(w * T), end.v[0].x() / w + 0.1 * std::sin(w * T)));
    }
    // dt ~ tolerance^(1/3), error ~ dt^2; steps that stay between two sizes leave some room
    const double expected = std::pow(100., 2. / 3);
    EXPECT_GT(errors[0] / errors[1], expected / 2);
    EXPECT_LT(errors[0] / errors[1], expected * 2);
    EXPECT_LT(errors[1], 1e-4);
}

TEST(TimeError, LetsStepsGrowOnceTheMotionHasDied) {
    support::SceneRun run;
    support::run_scene(run, scene_file("damped.yaml", one_element("1e-6 m", ", stiffness_damping: 1 s")),
                       {{"stages.swing.duration", "64 s"}, {"solver.smallest_step", "1e-5"}});
    const double end = last(run).time;
    const auto within = [&](double from, double to) {
        return std::ranges::count_if(run.steps, [&](const auto& step) { return step.time > from && step.time <= to; });
    };
    EXPECT_GT(within(1, 5), 20);
    EXPECT_LE(within(end - 32, end), 4);
}

/// The acceleration of nodes without mass means nothing: it must not cut steps.
TEST(TimeError, IgnoresNodesWithoutMass) {
    support::SceneRun kept, moved;
    for (auto* run : {&kept, &moved})
        support::run_scene(*run, support::shipped("validation/bouncing_rod.yaml"),
                           {{"stages.bounce.duration", "1"},
                            {"stages.bounce.steps", "200"},
                            {"stages.bounce.control.error_tolerance", "2e-4"},
                            {"stages.bounce.analysis.dynamic.contact_mass", run == &kept ? "kept" : "redistributed"}});
    EXPECT_LE(moved.attempts, kept.attempts * 1.2);
}

/// configs/validation/bouncing_rod.yaml: two bounces. Exact: contact in [1, 2] and [4, 5], reaction 1/2.
TEST(BouncingRod, TouchesForTheExactTimeWithTheExactForce) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("validation/bouncing_rod.yaml"),
                       {{"stages.bounce.duration", "6"}, {"stages.bounce.steps", "1200"}});
    const double E0 = 0.5 * 0.25 * 0.01, area = 0.01;
    double impulse = 0, first = 0, end = 0, before = 1;
    for (std::size_t k = 1; k < run.steps.size(); ++k) {
        const support::RunStep& step = run.steps[k];
        const double t = step.time - 1, force = step.pairs[0].on_slave.x() / area;
        if (t < 3) {
            impulse += force * (step.time - before);
            if (force > 0.25 && first == 0) first = t;
            if (force > 0.25) end = t;
        }
        before = step.time;
        EXPECT_LT(energy(step), E0 * (1 + 1e-6)) << "energy out of nowhere at " << t;
        EXPECT_NEAR(step.ledger.balance, 0, 1e-6 * E0);
    }
    const double front = 0.025; // how wide mesh and integrator draw the front of a wave: two and a half elements
    EXPECT_NEAR(first, 1, front);
    EXPECT_NEAR(end, 2, front);
    EXPECT_NEAR(impulse, 0.5, 0.5 * 0.02);
    EXPECT_GT(energy(last(run)), 0.985 * E0); // 1 % goes at once: the strain of the element without mass at its tip
}

struct Bounces {
    int contact_changes = 0;
    double least = 1e300, largest = 0; ///< energy after the start
};

Bounces bounce(const std::string& contact_mass, int steps) {
    support::SceneRun run;
    support::run_scene(
        run, support::shipped("validation/bouncing_rod.yaml"),
        {{"stages.bounce.analysis.dynamic", "{integrator: {newmark: {}}, contact_mass: " + contact_mass + "}"},
         {"stages.bounce.duration", "6"},
         {"stages.bounce.steps", std::to_string(steps)}});
    Bounces result;
    bool before = false;
    for (std::size_t k = 20; k < run.steps.size(); ++k) { // the tip's element has let go
        const bool now = contact::is_closed(run.steps[k].state.contact[0].status[0]);
        result.contact_changes += now != before;
        before = now;
        result.least = std::min(result.least, energy(run.steps[k]));
        result.largest = std::max(result.largest, energy(run.steps[k]));
    }
    return result;
}

TEST(BouncingRod, KeepsItsEnergyWhenContactNodesCarryNoMass) {
    for (const int steps : {1174, 4700}) {
        const Bounces run = bounce("redistributed", steps);
        EXPECT_EQ(run.contact_changes, 4) << "two bounces, no chatter";
        EXPECT_LT(run.largest - run.least, 1e-3 * run.largest);
    }
}

/// Why redistribution is the default: exact contact with mass on it feeds on every closing.
TEST(BouncingRod, GainsEnergyWithNewmarkWhenTheyDo) {
    const Bounces run = bounce("kept", 1174);
    EXPECT_GT(run.contact_changes, 20);
    EXPECT_GT(run.largest, 1.5 * run.least);
}

TEST(Mass, MovedOffContactNodesStaysInTheBody) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("validation/bouncing_rod.yaml"),
                       {{"stages.bounce.duration", "0.01"}, {"stages.bounce.steps", "1"}});
    const model::Model& m = run.plan.model;
    double rod = 0, tip = 0;
    for (Index i = 0; i < m.nodes(); ++i)
        for (Index k = m.consistent_mass.row_begin(i); k < m.consistent_mass.row_end(i); ++k) {
            const double mass = m.consistent_mass.block(k)(0, 0);
            if (i < m.bodies[0].nodes()) rod += mass;
            if (m.X[static_cast<std::size_t>(i)].x() == 0 && i < m.bodies[0].nodes()) tip += std::abs(mass);
        }
    const double exact = 0.01; // 1 m x 0.1 m x 0.1 m of 1 kg/m^3
    EXPECT_NEAR(rod, exact, 1e-14);
    EXPECT_EQ(tip, 0);
}

TEST(Stages, GiveTheInitialVelocityOnlyOnce) {
    const std::string text = R"(
bodies:
  bar:
    mesh: {block: {size: [2 m, 1 m, 1 m], divisions: [2, 1, 1]}}
    material: {linear_elastic: {E: 1 MPa, nu: 0.3, density: 1000 kg/m^3}}
    initial_velocity: [0.1 m/s, 0 m/s, 0 m/s]
sets: {end: {body: bar, surface: x_min}}
supports: {end: {fix: [x, y, z]}}
stages:
  swing: {analysis: dynamic, duration: 0.1 s, steps: 4}
  settle: {}
  rest: {analysis: dynamic, duration: 0.1 s, steps: 4}
)";
    support::SceneRun run;
    support::run_scene(run, scene_file("bar_settles.yaml", text));
    ASSERT_EQ(run.steps.size(), 9u);
    EXPECT_GT(run.steps[0].ledger.kinetic, 1);
    EXPECT_LT(last(run).ledger.kinetic, 1e-15); // round-off: statics leaves it at rest
}

/// configs/validation/two_bars.yaml, exact by the waves that run from the meeting and come back from the far ends.
TEST(TwoBars, TouchForTheTimeOfTheirWavesAndExchangeVelocities) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("validation/two_bars.yaml"));
    const double area = 0.01, stress = 0.05, p0 = 0.1 * area, E0 = 0.5 * 0.1 * 0.1 * area;
    double first = 0, end = 0, impulse = 0, sum = 0, before = 0;
    int plateau = 0;
    for (const support::RunStep& step : run.steps) {
        const double t = step.time, force = step.pairs[0].normal;
        impulse += force * (t - before);
        before = t;
        if (force > 0 && first == 0) first = t;
        if (force > 0) end = t;
        if (t > 0.3 && t < 1.9) {
            sum += force / area;
            ++plateau;
        }
        EXPECT_NEAR(step.ledger.linear.x(), p0, 1e-11 * p0); // round-off of 600 steps
        EXPECT_LT(energy(step), E0 * (1 + 1e-4));
        EXPECT_GT(energy(step), E0 * (1 - 1e-4));
    }
    const double front = 0.02; // two elements
    EXPECT_NEAR(first, 0.1, front);
    EXPECT_NEAR(end - first, 2, front);
    EXPECT_NEAR(sum / plateau, stress, 0.005 * stress); // measured: 4e-4
    EXPECT_NEAR(impulse, p0, 0.01 * p0);
    double left = 0;
    const model::Body& body = run.plan.model.bodies[0];
    for (Index i = 0; i < body.nodes(); ++i) left += last(run).state.v[body.first_node + i].x() / body.nodes();
    EXPECT_NEAR(left, 0, 0.02 * 0.1) << "the left bar has given its velocity away"; // its ends still ring
}

TEST(TwoBars, DoNotFlyThroughEachOtherInOneStep) {
    support::SceneRun run; // one step of 3 s: the left bar would come out behind the right one
    support::run_scene(run, support::shipped("validation/two_bars.yaml"),
                       {{"stages.impact.steps", "1"}, {"bodies.left.initial_velocity", "[0.5, 0, 0]"}});
    EXPECT_GT(run.attempts, static_cast<int>(run.steps.size())) << "nothing was cut";
    double largest = 0;
    for (const support::RunStep& step : run.steps) largest = std::max(largest, step.pairs[0].normal);
    EXPECT_GT(largest, 0) << "they have not met";
}

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
