/// Rigid bodies by themselves: free tops, the heavy top, driven and held motion, and what a run keeps of them.

#include "osculate/output/checkpoint_file.hpp"
#include "support/diary.hpp"
#include "support/floating_point_traps.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <boost/math/special_functions/jacobi_elliptic.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

// ---- free tops -------------------------------------------------------------------------------------------------------

/// A block of 3 m x 2 m x 1 m: its moments of inertia are as 5 : 10 : 13.
std::string free_top(const std::string& spin, double rho_inf, double duration, int steps) {
    return R"(
bodies:
  top:
    mesh: {block: {origin: [5 m, 3 m, 0 m], size: [3 m, 2 m, 1 m], divisions: [3, 2, 1]}}
    rigid: {density: 1}
    initial_velocity: [0.3, -0.2, 0.1]
    initial_spin: )" +
           spin + R"(
stages:
  spin:
    analysis: {dynamic: {integrator: {generalised_alpha: {rho_inf: )" +
           std::to_string(rho_inf) + R"(}}}}
    control: {step_size: fixed}
    duration: )" +
           std::to_string(duration) + "\n    steps: " + std::to_string(steps) + "\nsolver: {tolerance: 1e-13}\n";
}

support::SceneRun run(const std::string& text, const std::string& name = "rigid.yaml") {
    support::SceneRun result;
    support::run_scene(result, support::scene_file(name, text));
    return result;
}

TEST(FreeTop, KeepsEnergyAndMomentaAboutItsIntermediateAxis) {
    // it tumbles over again and again: thousands of steps
    constexpr double kept = 1e-10;
    const support::SceneRun top = run(free_top("[0.01, 2, 0.02]", 1, 100, 4000));
    const time::Ledger& first = top.steps.front().ledger;
    int turns = 0;
    for (std::size_t k = 1; k < top.steps.size(); ++k) {
        const time::Ledger& now = top.steps[k].ledger;
        ASSERT_NEAR(now.kinetic, first.kinetic, kept * first.kinetic);
        ASSERT_LT((now.linear - first.linear).norm(), kept * first.linear.norm());
        ASSERT_LT((now.angular - first.angular).norm(), kept * first.angular.norm());
        turns +=
            top.steps[k].state.rigid[0].angular_velocity.y() * top.steps[k - 1].state.rigid[0].angular_velocity.y() < 0;
        ASSERT_EQ(top.steps[k].iterations <= 3, true) << "the tangent is exact";
    }
    EXPECT_GT(turns, 5);
}

/// Euler's equations for moments 5, 10, 13 from the rates (1, 0, 1).                         [Landau & Lifshitz I, sec. 37]
Vec3 exact_rates(double t) {
    const double I1 = 5, I2 = 10, I3 = 13, M2 = I1 * I1 + I3 * I3, E2 = I1 + I3;
    const double k = std::sqrt((I2 - I1) * (E2 * I3 - M2) / ((I3 - I2) * (M2 - E2 * I1)));
    const double tau = t * std::sqrt((I3 - I2) * (M2 - E2 * I1) / (I1 * I2 * I3));
    double cn = 0, dn = 0;
    const double sn = boost::math::jacobi_elliptic(k, tau, &cn, &dn);
    return {std::sqrt((E2 * I3 - M2) / (I1 * (I3 - I1))) * cn, std::sqrt((E2 * I3 - M2) / (I2 * (I3 - I2))) * sn,
            std::sqrt((M2 - E2 * I1) / (I3 * (I3 - I1))) * dn};
}

double error_of_rates(double rho_inf, int steps) {
    constexpr double duration = 10;
    const support::SceneRun top = run(free_top("[1, 0, 1]", rho_inf, duration, steps));
    return (top.steps.back().state.rigid[0].angular_velocity - exact_rates(duration)).norm();
}

TEST(FreeTop, ConvergesAtSecondOrderToJacobisFunctions) {
    EXPECT_LT((exact_rates(0) - Vec3(1, 0, 1)).norm(), 1e-14);
    for (const double rho_inf : {1.0, 0.8}) {
        SCOPED_TRACE(rho_inf);
        const double coarse = error_of_rates(rho_inf, 400), fine = error_of_rates(rho_inf, 800);
        EXPECT_LT(fine, 2e-3);
        EXPECT_NEAR(coarse / fine, 4, 0.2);
    }
}

TEST(FreeTop, KeepsItsMomentumWithEveryIntegrator) {
    constexpr double kept = 1e-10;
    for (const double rho_inf : {0.0, 0.5, 0.8}) {
        const support::SceneRun top = run(free_top("[1, 0.3, 1]", rho_inf, 5, 100));
        const time::Ledger &first = top.steps.front().ledger, &last = top.steps.back().ledger;
        EXPECT_LT((last.angular - first.angular).norm(), kept * first.angular.norm());
        // what the integrator takes is in the ledger
        EXPECT_NEAR(last.kinetic + last.algorithmic, first.kinetic + first.algorithmic, kept * first.kinetic);
    }
}

// ---- the heavy top -----------------------------------------------------------------------------------------------------

constexpr double tilt = 0.5, precession = 1; // rad, rad/s

/// A square plate, 1 m above the point that it stands on, spinning so that it precesses steadily under gravity of 1 m/s^2.
support::SceneRun heavy_top(int steps) {
    const double J1 = (1 + 0.2 * 0.2) / 12 + 1, J3 = 2.0 / 12; // of 1 kg, about the point
    const double about_axis = (J1 * precession * std::cos(tilt) + 1 / precession) / J3;
    const Vec3 axis(std::sin(tilt), 0, std::cos(tilt));
    const Vec3 w = precession * Vec3::UnitZ() + (about_axis - precession * std::cos(tilt)) * axis;
    char spin[100];
    std::snprintf(spin, sizeof spin, "[%.17g, %.17g, %.17g]", w.x(), w.y(), w.z());
    return run(R"(
bodies:
  top:
    mesh: {block: {origin: [-0.5 m, -0.5 m, 0.9 m], size: [1 m, 1 m, 0.2 m], divisions: [2, 2, 1]}, rotate: {axis: [0, 1, 0], angle: )" +
                   std::to_string(tilt) + R"(}}
    rigid: {density: 5, reference_point: [0, 0, 0], fix: [x, y, z]}
    initial_spin: )" +
                   spin + R"(
gravity: [0, 0, -1]
stages:
  spin:
    analysis: {dynamic: {integrator: {generalised_alpha: {rho_inf: 1}}}}
    control: {step_size: fixed}
    duration: 6
    steps: )" + std::to_string(steps) +
                   "\nsolver: {tolerance: 1e-11}\n",
               "heavy_top.yaml");
}

/// Largest distance of the centre from its place, m.
double error_of_precession(const support::SceneRun& top) {
    double worst = 0;
    for (const support::RunStep& step : top.steps) {
        const double angle = precession * step.time;
        const Vec3 exact(std::sin(tilt) * std::cos(angle), std::sin(tilt) * std::sin(angle), std::cos(tilt));
        worst =
            std::max(worst, (model::centre_now(top.plan.model, top.plan.model.rigid[0], step.state) - exact).norm());
    }
    return worst;
}

TEST(HeavyTop, PrecessesSteadily) {
    const support::SceneRun coarse = heavy_top(300), fine = heavy_top(600);
    EXPECT_LT(error_of_precession(fine), 0.02);
    EXPECT_NEAR(error_of_precession(coarse) / error_of_precession(fine), 4, 0.3);
    const time::Ledger& last = coarse.steps.back().ledger;
    EXPECT_LT(std::abs(last.balance), 1e-10 * last.kinetic);
    EXPECT_LT(std::abs(last.algorithmic), 1e-10 * last.kinetic);
    // the point carries the weight, and the force towards the axis
    const support::RunStep& step = coarse.steps.back();
    for (const double u : step.state.u[static_cast<std::size_t>(coarse.plan.model.rigid[0].reference)]) EXPECT_EQ(u, 0);
}

/// A bar that hangs from its end, let go at a right angle: the period is an elliptic integral.
TEST(Pendulum, SwingsInItsPeriodWithTheDefaultIntegrator) {
    const support::SceneRun bar = run(R"(
gravity: [0, 0, -9.81]
bodies:
  bar:
    mesh: {block: {origin: [0, -0.05 m, -0.05 m], size: [1 m, 0.1 m, 0.1 m], divisions: [10, 1, 1]}}
    rigid: {density: 1000, reference_point: [0, 0, 0], fix: [x, y, z]}
stages:
  swing: {analysis: dynamic, duration: 5 s, steps: 500}
)");
    std::vector<double> passed; // the lowest place
    for (std::size_t k = 1; k < bar.steps.size(); ++k) {
        const auto left = [&](std::size_t i) {
            return bar.steps[i].state.rigid[0].rotation.y() - std::numbers::pi / 2;
        };
        if (left(k - 1) * left(k) >= 0) continue;
        const double share = left(k - 1) / (left(k - 1) - left(k));
        passed.push_back(bar.steps[k - 1].time + share * (bar.steps[k].time - bar.steps[k - 1].time));
    }
    ASSERT_GE(passed.size(), 5U);
    const double swings = static_cast<double>(passed.size() - 1) / 2;
    // 10 kg, about the end: J = m (1 + 0.1^2)/12 + m/4; amplitude 90 degrees
    const double period = 4 * std::sqrt((1.01 / 12 + 0.25) / (9.81 * 0.5)) * std::comp_ellint_1(std::sqrt(0.5));
    EXPECT_NEAR((passed.back() - passed.front()) / swings, period, 5e-4 * period);
    const time::Ledger& last = bar.steps.back().ledger;
    EXPECT_NEAR(last.kinetic, last.external, 1e-4 * last.kinetic);
}

// ---- driven motion, loads ------------------------------------------------------------------------------------------------

TEST(RigidBody, TurnsAsItIsDrivenBeyondAWholeTurn) {
    const support::SceneRun turned = run(R"(
bodies:
  tool:
    mesh: {block: {size: [1 m, 1 m, 1 m], divisions: [2, 2, 2]}}
    rigid: {reference_point: [0, 0, 0], fix: [x, z, rx, ry]}
stages:
  turn:
    steps: 10
    motion: {tool: {rz: 500 deg, y: 2 m}}
  back:
    steps: 5
    motion: {tool: {rz: {table: [[0, 500 deg], [1, 90 deg]]}}}
)");
    const model::Model& model = turned.plan.model;
    const auto check = [&](const support::RunStep& step, double angle) {
        EXPECT_NEAR(step.state.rigid[0].rotation.z(), angle, 1e-12);
        EXPECT_LT(step.state.rigid[0].rotation.head<2>().norm(), 1e-12);
        for (std::size_t i = 0; i < model.rigid[0].nodes.size(); ++i) {
            const Vec3 x = Eigen::AngleAxisd(angle, Vec3::UnitZ()) * model.X[i] + Vec3(0, 2, 0);
            EXPECT_LT((model.X[i] + step.state.u[i] - x).norm(), 1e-12);
        }
    };
    check(turned.steps[9], 500 * std::numbers::pi / 180);
    check(turned.steps[14], std::numbers::pi / 2);
}

/// A constant moment about a principal axis: the angle is M t^2/(2 J), to the last digits, as is the work.
TEST(RigidBody, IsSpunUpByAMoment) {
    const support::SceneRun spun = run(R"(
bodies:
  wheel:
    mesh: {cylinder: {radius: 0.5 m, length: 0.1 m, divisions: [4, 2, 1]}}
    rigid: {mass: 2 kg, centre: [0, 0, 0.05], inertia: [0.2, 0.2, 0.4], fix: [x, y, z]}
stages:
  spin:
    analysis: {dynamic: {integrator: {generalised_alpha: {rho_inf: 1}}}}
    control: {step_size: fixed}
    ramp: step
    duration: 3
    steps: 60
    moment: {wheel: [0, 0, 0.8]}
)");
    const support::RunStep& last = spun.steps.back();
    const model::RigidMotion& motion = last.state.rigid[0];
    EXPECT_NEAR(motion.angular_velocity.z(), 0.8 / 0.4 * 3, 1e-9);
    EXPECT_NEAR(motion.rotation.z(), 0.8 / 0.4 * 9 / 2,
                0.05); // tangents of half the angles follow the trapezoidal rule
    EXPECT_NEAR(last.ledger.external, last.ledger.kinetic, 1e-9);
    EXPECT_NEAR(last.ledger.angular.z(), 0.8 * 3, 1e-9);
}

/// Mass properties of a volume: a ball, to the accuracy of its mesh, and a block exactly.
TEST(RigidBody, HasTheInertiaOfItsVolume) {
    const support::SceneRun block = run(free_top("[0, 0, 1]", 1, 0.1, 1));
    const model::RigidBody& body = block.plan.model.rigid[0];
    EXPECT_NEAR(body.mass, 6, 1e-12);
    EXPECT_LT((body.centre - Vec3(6.5, 4, 0.5) + block.plan.model.origin).norm(), 1e-12);
    EXPECT_LT((body.inertia - Mat3(Vec3(2.5, 5, 6.5).asDiagonal())).norm(), 1e-12);
}

// ---- what a run keeps ------------------------------------------------------------------------------------------------------

const char* const dropped = R"(
gravity: [0, 0, -9.81]
bodies:
  slab:
    mesh: {block: {origin: [-0.4 m, -0.4 m, -0.2 m], size: [0.8 m, 0.8 m, 0.2 m], divisions: [6, 6, 2]}}
    material: {neo_hookean: {E: 1 MPa, nu: 0.3, density: 1000}}
  ball:
    mesh: {ball: {radius: 0.2 m, divisions: [4, 2, 4]}, translate: [0.01, 0.02, 0.205]}
    rigid: {density: 2000}
    initial_spin: [0, 5, 1]
sets:
  bottom: {body: slab, surface: z_min}
  top: {body: slab, surface: z_max}
  sphere: {body: ball, surface: outer}
supports:
  bottom: {fix: [x, y, z]}
contact:
  touch: {slave: top, master: {set: sphere}, friction: 0.3}
stages:
  fall: {analysis: dynamic, duration: 0.1 s, steps: 20}
)";

struct Part final : time::StepObserver {
    explicit Part(int threads = 1, int reject_every = 0) {
        const scene::Scene scene = scene::read_scene(support::scene_file("dropped.yaml", dropped));
        plan = app::compile(scene, app::build_meshes(scene), threads, timings);
        plan.stepper.reject_every = reject_every;
    }
    Part& go(const std::string* from = nullptr) {
        time::Stepper stepper(plan.model, plan.stages, plan.stepper, timings);
        if (from != nullptr) stepper.resume(output::decode(*from).run);
        stepper.run(*this);
        return *this;
    }
    void attempted(const time::Attempt& a, const std::vector<equilibrium::IterationRecord>& i) override {
        diary.attempted(a, i);
    }
    void accepted(const time::AcceptedStep& step) override { diary.accepted(step); }
    void between_steps(const std::function<time::Checkpoint()>& checkpoint) override {
        if (diary.states.size() % 7 != 0) return;
        output::CheckpointFile file;
        file.run = checkpoint();
        files.push_back(output::encode(file));
    }
    Timings timings;
    app::Plan plan;
    support::Diary diary;
    std::vector<std::string> files;
};

void expect_same(const support::Diary& a, const support::Diary& b) {
    support::expect_same_end(a, b);
    const model::RigidMotion &x = a.states.back().rigid[0], &y = b.states.back().rigid[0];
    EXPECT_EQ(x.orientation.coeffs(), y.orientation.coeffs());
    EXPECT_EQ(x.angular_velocity, y.angular_velocity);
    EXPECT_EQ(x.velocity, y.velocity);
    EXPECT_EQ(x.moment, y.moment);
}

TEST(RigidBody, GoesOnFromACheckpointToTheBit) {
    const Part straight = std::move(Part().go());
    ASSERT_GE(straight.files.size(), 2U);
    EXPECT_GT(straight.diary.states.back().contact[0].lambda[24].norm(), 0);
    for (const std::string& file : straight.files) {
        SCOPED_TRACE(file.size());
        Part rest;
        rest.go(&file);
        if (!rest.diary.states.empty()) expect_same(straight.diary, rest.diary);
    }
}

TEST(RigidBody, IsTheSameForAnyNumberOfThreadsAndAfterRejectedSteps) {
    const Part straight = std::move(Part().go());
    {
        SCOPED_TRACE("again");
        expect_same(straight.diary, Part().go().diary);
    }
    for (const int threads : {2, 3}) {
        SCOPED_TRACE(threads);
        expect_same(straight.diary, Part(threads).go().diary);
    }
    const Part rejected = std::move(Part(1, 3).go());
    EXPECT_GT(rejected.diary.count(time::Reason::forced), 5);
    expect_same(straight.diary, rejected.diary);
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
