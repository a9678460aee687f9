/// Bodies at finite strain against what is known of large rotations and strains.

#include "osculate/fe/facet_quadrature.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

/// A scene of its own, written where the test runs.
std::string scene_file(const std::string& name, const std::string& text) {
    return support::scene_file(name + ".yaml", "name: " + name + "\n" + text);
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

INSTANTIATE_TEST_SUITE_P(All, Stretched, testing::Values("hex8", "wedge6", "tet4", "tet10", "wedge15"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST(FollowerPressure, IsTheCauchyStressOfTheBlock) {
    // p on the current area: sigma = P / b^2 = -p, by bisection for the stretch
    const double p = 3e5;
    double low = 0.3, high = 1, width = 1;
    for (int i = 0; i < 60; ++i) {
        const double a = (low + high) / 2, P = neo_hookean_tension(1e6, 0.3, a, width);
        (P / (width * width) < -p ? low : high) = a;
    }
    for (const char* element : {"hex8", "tet4", "tet10"}) {
        support::SceneRun run;
        support::run_scene(run, scene_file("squeezed", stretched_block),
                           {{"bodies.block.mesh.block.element", element},
                            {"stages.stretch.displacement", "{}"},
                            {"stages.stretch.follower_pressure", "{right: 300 kPa}"}});
        const auto& model = run.plan.model;
        for (std::size_t i = 0; i < model.X.size(); ++i)
            EXPECT_NEAR(run.steps.back().state.u[i].x(), (low - 1) * model.X[i].x(), 1e-8);
        for (const auto& step : run.steps) EXPECT_LE(step.iterations, 7) << "Newton with the exact tangent";
    }
}

TEST(FollowerPressure, WorksOverTheStepWithTheMeanOfItsForcesAtBothEnds) {
    support::SceneRun run;
    support::run_scene(run, scene_file("pumped", stretched_block),
                       {{"bodies.block.material.neo_hookean.density", "1000 kg/m^3"},
                        {"stages.stretch", "{analysis: {dynamic: {integrator: {generalised_alpha: {rho_inf: 1}}}}, "
                                           "duration: 50 ms, steps: 100, ramp: step, "
                                           "follower_pressure: {right: 100 kPa}}"}});
    double swept = 0; // m^3
    Field before(run.plan.model.X.size());
    for (const auto& step : run.steps) {
        for (const auto& face : run.plan.stages[0].follower_pressures[0].faces)
            for (const Field* u : {&std::as_const(before), &step.state.u}) {
                const auto f = fe::pressure_forces(face, sum(run.plan.model.X, *u), 1);
                for (int c = 0; c < face.count; ++c)
                    swept += 0.5 * f[c].dot(step.state.u[face.nodes[c]] - before[face.nodes[c]]);
            }
        before = step.state.u;
    }
    const auto& ledger = run.steps.back().ledger;
    EXPECT_GT(ledger.external, 0.01 * 1e5);
    EXPECT_NEAR(ledger.external, 1e5 * swept, 1e-9 * ledger.external);
    EXPECT_LT(std::abs(ledger.balance), 1e-6 * ledger.external);
}

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

/// Strain energy of the centrifugal stretch rho omega^2 l^2/(2 E) at its largest, throughout, coming on at once: twice the
/// strain, four times the energy. J
const double centrifugal =
    4 * 0.5 * 1e9 * std::pow(1000 * std::pow(2 * std::numbers::pi * 0.5, 2) / (2 * 1e9), 2) * 0.08;

/// Relative errors after two turns.
struct SpinErrors {
    double position = 0, angular = 0, energy = 0, linear = 0, largest_strain_energy = 0;
};

SpinErrors spin(int steps) {
    support::SceneRun run;
    support::run_scene(run, scene_file("spinning", spinning), {{"stages.turn.steps", std::to_string(steps)}});
    const double mass = 80, inertia = mass * (1 + 0.16) / 12, omega = 2 * std::numbers::pi;
    const auto& last = run.steps.back();
    SpinErrors errors;
    for (std::size_t i = 0; i < run.plan.model.X.size(); ++i)
        errors.position = std::max(errors.position, (last.state.u[i] - Vec3(2, 0, 0)).norm());
    errors.linear = std::abs(last.ledger.linear.x() / mass - 1);
    errors.angular = std::abs((last.ledger.angular.z() + mass * 0.2) / (inertia * omega) - 1); // centre at y = 0.2 m
    const double energy = mass / 2 + inertia * omega * omega / 2;
    errors.energy = std::abs((last.ledger.kinetic + last.ledger.strain) / energy - 1);
    for (const auto& step : run.steps)
        errors.largest_strain_energy = std::max(errors.largest_strain_energy, step.ledger.strain);
    return errors;
}

TEST(SpinningBlock, TurnsWithoutStrain) {
    const SpinErrors coarse = spin(200), fine = spin(400);
    constexpr double solver = 1e-7; // its tolerance is 1e-9 of the forces of a step; errors add up over 400
    EXPECT_LT(fine.linear, solver);
    EXPECT_LT(coarse.angular, solver) << "conserved whatever the step";
    EXPECT_LT(coarse.energy, solver) << "conserved whatever the step";
    // The trapezoidal rule is of second order: half the step, a quarter of the error. The position comes late by
    // (omega dt)^2/12 of the angle turned, 4 pi, at a radius of 0.54 m.
    const double lag = std::pow(2 * std::numbers::pi * 0.005, 2) / 12 * 4 * std::numbers::pi * 0.54;
    EXPECT_LT(fine.position, 10 * lag);
    EXPECT_GT(coarse.position / fine.position, 3);
    EXPECT_LT(coarse.position / fine.position, 5);
    EXPECT_LT(fine.largest_strain_energy, centrifugal);
}

TEST(SpinningBlock, DissipatesWithItsIntegratorAndNeverGainsEnergy) {
    support::SceneRun
        run; // 20 steps a turn; the mean of the forces at both ends multiplies the energy by a hundred here
    support::run_scene(
        run, scene_file("spinning_coarse", spinning),
        {{"stages.turn.steps", "40"}, {"stages.turn.analysis.dynamic.integrator.generalised_alpha.rho_inf", "0.8"}});
    double last = run.steps.front().ledger.kinetic + run.steps.front().ledger.strain;
    const double first = last;
    // what an alpha member makes monotone is the energy but for terms (alpha_f - alpha_m)(omega dt)^2 at both ends
    const double alphas = 1.0 / 9; // alpha_f = 4/9, alpha_m = 1/3
    const double norm = 2 * alphas * std::pow(2 * std::numbers::pi * 0.05, 2);
    for (const auto& step : run.steps) {
        const double energy = step.ledger.kinetic + step.ledger.strain;
        EXPECT_LT(energy, last + norm * first);
        last = energy;
    }
    EXPECT_LT(last, (1 + norm) * first);
    EXPECT_GT(last, (1 - norm) * first);
}

TEST(SpinningBlock, IsNotBrakedByStiffnessDamping) {
    support::SceneRun run;
    support::run_scene(run, scene_file("spinning_damped", spinning),
                       {{"stages.turn.analysis.dynamic.stiffness_damping", "1 ms"}});
    const auto& last = run.steps.back().ledger;
    // what is damped is the centrifugal vibration at the start, not the turning
    EXPECT_LT(last.damping, centrifugal);
    EXPECT_NEAR(last.kinetic, run.steps.front().ledger.kinetic, centrifugal);
}

const char* const small_strain = R"(
bodies:
  base:
    mesh: {block: {size: [1 m, 1 m, 0.5 m], divisions: [4, 4, 2]}}
    material: {linear_elastic: {E: 1 MPa, nu: 0.3}}
  block:
    mesh: {block: {origin: [0.3 m, 0.3 m, 0.5 m], size: [0.4 m, 0.4 m, 0.4 m], divisions: [3, 3, 2]}}
    material: {linear_elastic: {E: 1 MPa, nu: 0.3}}
sets:
  bottom: {body: base, surface: z_min}
  ground: {body: base, surface: z_max}
  sole: {body: block, surface: z_min}
  top: {body: block, surface: z_max}
supports:
  bottom: {fix: [x, y, z]}
contact:
  rubbing: {slave: sole, master: {set: ground}, friction: 0.3}
stages:
  press: {displacement: {top: {x: 0 m, y: 0 m, z: -1 um}}}
  rub: {displacement: {top: {x: 2 um}}}
output: {template: minimal}
)";

TEST(SmallStrain, IsTheLimitOfFiniteStrain) {
    support::SceneRun linear, finite;
    const std::string path = scene_file("small_strain", small_strain);
    support::run_scene(linear, path);
    support::run_scene(finite, path,
                       {{"bodies.base.material", "{neo_hookean: {E: 1 MPa, nu: 0.3}}"},
                        {"bodies.block.material", "{saint_venant_kirchhoff: {E: 1 MPa, nu: 0.3}}"}});
    const double N = linear.steps[0].pairs[0].normal;
    ASSERT_GT(N, 0);
    constexpr double strain = 1e-4; // 1 um over 0.4 m, some forty times more at the corners
    EXPECT_NEAR(finite.steps[0].pairs[0].normal, N, strain * N);
    EXPECT_NEAR(finite.steps[1].pairs[0].friction, linear.steps[1].pairs[0].friction, strain * N);
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
