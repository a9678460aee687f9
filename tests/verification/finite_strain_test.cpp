/// Bodies at finite strain against what is known of large rotations and strains.

#include "support/scene_runner.hpp"

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>
#include <numbers>

namespace osculate {
namespace {

/// A scene of its own, written where the test runs.
std::string scene_file(const std::string& name, const std::string& text) {
    const std::string path = testing::TempDir() + name + ".yaml";
    std::ofstream(path) << "name: " << name << "\n" << text;
    return path;
}

// ---- large strains ---------------------------------------------------------------------------------------------------

const char* const stretched_block = R"(
bodies:
  block:
    mesh: {block: {size: [1 m, 1 m, 1 m], divisions: [2, 2, 2]}}
    material: {neo_hookean: {E: 1 MPa, nu: 0.3}}
sets:
  left: {body: block, surface: x_min}
  right: {body: block, surface: x_max}
  front: {body: block, surface: y_min}
  floor: {body: block, surface: z_min}
supports:
  left: {fix: [x]}
  front: {fix: [y]}
  floor: {fix: [z]}
stages:
  stretch:
    steps: 4
    displacement: {right: {x: 1 m}}
output: {template: minimal}
)";

/// Uniaxial stress at stretch a: the lateral stretch b makes S_yy vanish, mu (1 - 1/b^2) + lambda ln(a b^2)/b^2 = 0, and
/// the force per reference area is P = a S_xx = mu (a - 1/a) + lambda ln(a b^2)/a.
double neo_hookean_tension(double E, double nu, double a, double& b) {
    const double lambda = E * nu / ((1 + nu) * (1 - 2 * nu)), mu = E / (2 * (1 + nu));
    b = 1;
    for (int i = 0; i < 50; ++i) { // Newton, f = mu (b^2 - 1) + lambda ln(a b^2)
        const double f = mu * (b * b - 1) + lambda * std::log(a * b * b), df = 2 * mu * b + 2 * lambda / b;
        b -= f / df;
    }
    return mu * (a - 1 / a) + lambda * std::log(a * b * b) / a;
}

class Stretched : public testing::TestWithParam<const char*> {};

TEST_P(Stretched, BlockHasTheExactForceAndWidth) {
    for (const double elongation : {1.0, -0.5}) {
        support::SceneRun run;
        support::run_scene(run, scene_file("stretched", stretched_block),
                           {{"bodies.block.mesh.block.element", GetParam()},
                            {"stages.stretch.displacement.right.x", std::to_string(elongation) + " m"}});
        double width = 1;
        const double force = neo_hookean_tension(1e6, 0.3, 1 + elongation, width);
        constexpr double solver = 1e-8; // tolerance 1e-9 of the reference force, norms over nodes and components
        const auto& last = run.steps.back();
        double reaction = 0;
        for (std::size_t s = 0; s < run.plan.constrained_sets.size(); ++s)
            if (run.plan.model.sets[run.plan.constrained_sets[s]].name == "right") reaction = last.reactions[s].x();
        EXPECT_NEAR(reaction, force, solver * 1e6);
        for (std::size_t i = 0; i < run.plan.model.X.size(); ++i) // homogeneous, whatever the elements
            EXPECT_NEAR(last.state.u[i].y(), (width - 1) * run.plan.model.X[i].y(), solver);
    }
}

INSTANTIATE_TEST_SUITE_P(All, Stretched, testing::Values("hex8", "wedge6", "tet4", "tet10"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST(CrushedBlock, NamesTheElementThatTurnsInsideOut) {
    support::SceneRun run;
    try {
        support::run_scene(run, scene_file("crushed", stretched_block),
                           {{"stages.stretch.displacement.right.x", "-1.5 m"}});
        FAIL() << "a block cannot be shorter than nothing";
    } catch (const RunFailure& failure) {
        EXPECT_NE(std::string(failure.what()).find("inside out"), std::string::npos) << failure.what();
        EXPECT_NE(std::string(failure.what()).find("of body 'block'"), std::string::npos) << failure.what();
    }
    EXPECT_GE(run.steps.size(), 2U) << "what could be reached is kept";
}

// ---- large rotations -------------------------------------------------------------------------------------------------

const char* const cantilever = R"(
bodies:
  beam:
    mesh: {block: {size: [20 m, 1 m, 1 m], divisions: [20, 1, 2], element: tet10}}
    material: {saint_venant_kirchhoff: {E: 1 MPa, nu: 0}}
sets:
  root: {body: beam, surface: x_min}
  tip: {body: beam, box: {min: [19.99 m, -1 m, 0.49 m], max: [20.01 m, 2 m, 0.51 m]}}
supports:
  root: {fix: [x, y, z]}
stages:
  bend:
    steps: 8
    displacement: {tip: {z: 9.87 m}}
output: {template: minimal}
)";

TEST(Cantilever, BendsAsTheElastica) {
    support::SceneRun run;
    support::run_scene(run, scene_file("cantilever", cantilever));
    // the inextensible elastica under a dead end load with P L^2/(E I) = 2 has w/L = 0.4935, u/L = 0.1606
    // [Mattiasson 1981, Int. J. Num. Meth. Engng 17, 145]
    const double EI = 1e6 / 12, L = 20, P = 2 * EI / (L * L);
    const auto& last = run.steps.back();
    double reaction = 0, shortening = 0;
    for (std::size_t s = 0; s < run.plan.constrained_sets.size(); ++s)
        if (const auto& set = run.plan.model.sets[run.plan.constrained_sets[s]]; set.name == "tip") {
            reaction = last.reactions[s].z();
            shortening = -last.state.u[set.nodes.front()].x();
        }
    // shear gives way by about (h/L)^2 and the mesh by less: one part in a hundred
    EXPECT_NEAR(reaction, P, 0.01 * P);
    EXPECT_NEAR(shortening, 0.1606 * L, 0.01 * L);
}

const char* const spinning = R"(
bodies:
  block:
    mesh: {block: {size: [1 m, 0.4 m, 0.2 m], divisions: [4, 2, 1]}}
    material: {saint_venant_kirchhoff: {E: 1 GPa, nu: 0.3, density: 1000 kg/m^3}}
    initial_velocity: [1 m/s, 0 m/s, 0 m/s]
    initial_spin: [0 rad/s, 0 rad/s, 6.283185307179586 rad/s]
stages:
  turn:
    analysis:
      dynamic: {integrator: {generalised_alpha: {rho_inf: 1}}}
    duration: 2 s
    steps: 400
output: {template: minimal}
)";

TEST(SpinningBlock, TurnsWithoutStrain) {
    support::SceneRun run;
    support::run_scene(run, scene_file("spinning", spinning));
    const auto& first = run.steps.front().ledger;
    const auto& last = run.steps.back().ledger;
    const double omega = 2 * std::numbers::pi;
    // centrifugal strain rho omega^2 l^2/(2 E) at its largest, squared in the energy, that comes on at once: twice
    const double strain = 1000 * omega * omega * 0.25 / (2 * 1e9), volume = 0.08;
    for (const auto& step : run.steps) EXPECT_LT(step.ledger.strain, 4 * 0.5 * 1e9 * strain * strain * volume);
    // momentum: exact but for round-off; angular momentum: the trapezoidal rule turns each point on its chord, with an
    // error of (omega dt)^2/12 in the radius and none that grows
    const double chord = std::pow(omega * 0.005, 2) / 4;
    EXPECT_NEAR(last.linear.x(), first.linear.x(), 1e-9 * first.linear.x());
    EXPECT_NEAR(last.angular.z(), first.angular.z(), chord * first.angular.z());
    EXPECT_NEAR(last.kinetic + last.strain, first.kinetic + first.strain, chord * first.kinetic);
    // two turns on, the block stands as it stood, but for the period error (omega dt)^2/12 of the trapezoidal rule
    const double turned = 2 * 2 * std::numbers::pi, lag = turned * std::pow(omega * 0.005, 2) / 12;
    for (std::size_t i = 0; i < run.plan.model.X.size(); ++i)
        EXPECT_LT((run.steps.back().state.u[i] - Vec3(2, 0, 0)).norm(), 2 * lag * 0.6);
}

TEST(SpinningBlock, IsNotBrakedByStiffnessDamping) {
    support::SceneRun run;
    support::run_scene(run, scene_file("spinning_damped", spinning),
                       {{"stages.turn.analysis.dynamic.stiffness_damping", "1 ms"}});
    const auto& last = run.steps.back().ledger;
    // what is damped is the centrifugal vibration at the start, not the turning
    EXPECT_LT(last.damping, 1e-6 * last.kinetic);
    EXPECT_NEAR(last.kinetic, run.steps.front().ledger.kinetic, 1e-4 * last.kinetic);
}

TEST(SmallStrain, IsTheLimitOfFiniteStrain) {
    // the press of the half-tube with a thousandth of the pressure: differences are of the order of the strain
    support::SceneRun linear, finite;
    const std::vector<scene::Override> common{{"bodies.tube.mesh.half_tube.divisions", "[9, 6, 1]"},
                                              {"bodies.contactor.mesh.contactor.divisions", "[6, 8, 2]"},
                                              {"stages.press.pressure.top", "1 Pa"},
                                              {"stages.slide.steps", "1"},
                                              {"stages.slide.duration", "1 s"},
                                              {"stages.slide.displacement.rear.y", "1 um"}};
    auto overrides = common;
    support::run_scene(linear, support::shipped("paper/half_tube.yaml"), overrides);
    overrides.push_back({"bodies.tube.material", "{neo_hookean: {E: 30 MPa, nu: 0.2}}"});
    overrides.push_back({"bodies.contactor.material", "{saint_venant_kirchhoff: {E: 10 MPa, nu: 0.2}}"});
    support::run_scene(finite, support::shipped("paper/half_tube.yaml"), overrides);
    const double N = linear.steps[0].pairs[0].normal;
    constexpr double strain = 1e-6; // pressure over modulus 1e-7, concentrated tenfold
    EXPECT_NEAR(finite.steps[0].pairs[0].normal, N, strain * N);
    EXPECT_NEAR(finite.steps[1].pairs[0].friction, linear.steps[1].pairs[0].friction, strain * N);
}

} // namespace
} // namespace osculate
