/// Implicit dynamics without contact, against exact solutions.

#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

constexpr double pi = std::numbers::pi;

using support::scene_file;

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
    EXPECT_TRUE(m.kept_contact_mass.empty());
}

/// A bar whose whole skin may touch: an inner line of nodes alone would have no inertia about it.
TEST(Mass, OfABarWhoseSkinIsAllSlaveStillSpins) {
    const std::string text = R"(
bodies:
  bar:
    mesh: {block: {origin: [-50 mm, -10 mm, -10 mm], size: [100 mm, 20 mm, 20 mm], divisions: [10, 2, 2]}}
    material: {linear_elastic: {E: 1 GPa, nu: 0.3, density: 8000 kg/m^3}}
    initial_spin: [100 rad/s, 0 rad/s, 0 rad/s]
  wall:
    mesh: {block: {origin: [-1 m, -1 m, -2 m], size: [2 m, 2 m, 1 m], divisions: [1, 1, 1]}}
    material: {linear_elastic: {E: 1 GPa, nu: 0.3, density: 8000 kg/m^3}}
sets:
  skin: {body: bar, box: {min: [-1 m, -1 m, -1 m], max: [1 m, 1 m, 1 m]}}
  top: {body: wall, surface: z_max}
  all: {body: wall, box: {min: [-9 m, -9 m, -9 m], max: [9 m, 9 m, 9 m]}}
supports: {all: {fix: [x, y, z]}}
contact: {never: {slave: skin, master: {set: top, surface: facets}}}
stages: {spin: {analysis: dynamic, duration: 1 us, steps: 1}}
)";
    support::SceneRun run;
    support::run_scene(run, scene_file("spun.yaml", text));
    const double mass = 0.32, side = 0.02, rate = 100, round_off = 1e-3; // of a microsecond's stretching
    const double exact = 0.5 * mass * side * side / 6 * rate * rate;
    EXPECT_NEAR(last(run).ledger.kinetic, exact, round_off * exact);
    EXPECT_EQ(run.plan.model.kept_contact_mass, std::vector<Index>{0});
}

/// What a support pushes back with in statics it pushes back with in dynamics: the same weights at the same nodes.
TEST(Mass, AtRestStaysAtRestWhereDynamicsFollowsStatics) {
    for (const char* layers : {"1", "2", "6"}) {
        const std::string text = std::string(R"(
bodies:
  block:
    mesh: {block: {size: [100 mm, 100 mm, 100 mm], divisions: [3, 3, )") +
                                 layers + R"(]}}
    material: {linear_elastic: {E: 1 MPa, nu: 0.3, density: 1000 kg/m^3}}
  table:
    mesh: {block: {origin: [-0.1 m, -0.1 m, -0.1 m], size: [0.3 m, 0.3 m, 0.1 m], divisions: [2, 2, 1]}}
    material: {linear_elastic: {E: 1 GPa, nu: 0.3, density: 1000 kg/m^3}}
sets:
  foot: {body: block, surface: z_min}
  top: {body: table, surface: z_max}
  all: {body: table, box: {min: [-9 m, -9 m, -9 m], max: [9 m, 9 m, 9 m]}}
supports: {all: {fix: [x, y, z]}}
contact: {rest: {slave: foot, master: {set: top, surface: facets}, friction: 0.3}}
gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
stages:
  settle: {}
  rest: {analysis: dynamic, duration: 0.1 s, steps: 20}
)";
        support::SceneRun run;
        support::run_scene(run, scene_file("rest.yaml", text));
        const double weight = 9.81, solved_to = 1e-7;
        for (const support::RunStep& step : run.steps)
            EXPECT_NEAR(step.pairs[0].on_slave.z(), weight, solved_to * weight) << layers << " layers at " << step.time;
    }
}

/// The initial velocity of a body is not that of what holds it: it would come and go there, step by step, for ever.
TEST(Stages, LeaveHeldNodesAtRestWhereABodyIsThrown) {
    const std::string text = R"(
bodies:
  bar:
    mesh: {block: {size: [2 m, 1 m, 1 m], divisions: [2, 1, 1]}}
    material: {linear_elastic: {E: 1 MPa, nu: 0.3, density: 1000 kg/m^3}}
    initial_velocity: [0.1 m/s, 0 m/s, 0.1 m/s]
sets: {end: {body: bar, surface: x_min}}
supports: {end: {fix: [x, y, z]}}
stages:
  swing: {analysis: {dynamic: {integrator: {newmark: {}}}}, duration: 0.1 s, steps: 50}
)";
    support::SceneRun run;
    support::run_scene(run, scene_file("bar_thrown.yaml", text));
    for (const support::RunStep& step : run.steps) {
        for (Index i = 0; i < 12; ++i)
            if (run.plan.model.X[static_cast<std::size_t>(i)].x() == 0) {
                EXPECT_TRUE(step.state.v[static_cast<std::size_t>(i)].isZero(0));
            }
        EXPECT_NEAR(energy(step), energy(run.steps[0]), 1e-11 * energy(run.steps[0]));
    }
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

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
