/// Interfaces that give way, in dynamics: a block that hits a floor is a mass on a spring, with or without a damper.

#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

constexpr double m = 1, v0 = 1, A = 0.01, k = 1e8; // kg, m/s, m^2, Pa/m
const double omega = std::sqrt(k * A / m);         // 1000 rad/s, depth 1 mm; the block is 1e4 times as stiff

std::string block_on_floor(const std::string& pair, const std::string& stages) {
    return R"(
bodies:
  floor:
    mesh: {block: {origin: [-0.05 m, -0.05 m, -0.1 m], size: [0.2 m, 0.2 m, 0.1 m], divisions: [3, 3, 1]}}
    material: {linear_elastic: {E: 1e11 Pa, nu: 0, density: 1000 kg/m^3}}
  block:
    mesh: {block: {origin: [0 m, 0 m, 0.0001 m], size: [0.1 m, 0.1 m, 0.1 m], divisions: [2, 2, 1]}}
    material: {linear_elastic: {E: 1e11 Pa, nu: 0, density: 1000 kg/m^3}}
    initial_velocity: [0 m/s, 0 m/s, -1 m/s]
sets:
  bottom: {body: floor, surface: z_min}
  crest: {body: floor, surface: z_max}
  base: {body: block, surface: z_min}
supports:
  bottom: {fix: [x, y, z]}
contact:
  joint:
    slave: base
    master: {set: crest, surface: facets}
)" + pair + stages;
}

std::string flight(double duration, int steps, const std::string& control = "{step_size: fixed}") {
    return "stages:\n  flight: {analysis: {dynamic: {integrator: {generalised_alpha: {rho_inf: 1}}}}, duration: " +
           std::to_string(duration) + " s, steps: " + std::to_string(steps) + ", control: " + control + "}\n";
}

support::SceneRun solved(const std::string& text) {
    support::SceneRun run;
    support::run_scene(run, support::scene_file("soft_impact.yaml", text));
    return run;
}

/// Mean velocity of the block.
Vec3 velocity(const support::SceneRun& run) {
    const model::Body& block = run.plan.model.bodies[1];
    const std::size_t count = block.mesh.nodes.size(), first = static_cast<std::size_t>(block.first_node);
    Vec3 sum = Vec3::Zero();
    for (std::size_t i = 0; i < count; ++i) sum += run.steps.back().state.v[first + i] / static_cast<double>(count);
    return sum;
}

const std::string linear = "    pressure_overclosure: {linear: {stiffness: 1e8 N/m^3}}\n",
                  exponential = "    pressure_overclosure: {exponential: {pressure: 10 kPa, clearance: 0.5 mm}}\n";

TEST(SoftImpact, ThrowsBackWithTheSpeedItCameWith) {
    // the exponential has a pressure across the gap at the start: integral of p(h) and of the tangent before it
    const double p0 = 1e4, growth = std::log(100.) / 0.5e-3, gap = 1e-4;
    const double across = A * (p0 * std::exp(-growth * gap) - 0.005 * p0) / growth;
    for (const auto& [law, stored] : {std::pair(linear, 0.0), std::pair(exponential, across)})
        for (const char* discretisation : {"node", "mortar"}) {
            const auto run =
                solved(block_on_floor(law + "    discretisation: " + discretisation + "\n", flight(6e-3, 120)));
            const double start = 0.5 * m * v0 * v0 + stored, v = std::sqrt(2 * start / m);
            EXPECT_NEAR(velocity(run).z(), v, 1e-3 * v) << discretisation; // vibrations take 1e-4 of the energy
            for (const support::RunStep& step : run.steps) {
                const time::Ledger& now = step.ledger;
                EXPECT_NEAR(now.kinetic + now.strain, start, 1e-5 * start) << "of block, floor and interface";
                EXPECT_NEAR(now.contact, 0, 1e-5 * start); // facets turn with the floor's strain
            }
        }
}

TEST(SoftImpact, TakesHalfAPeriodAndGoesAsDeepAsASpring) {
    const auto run = solved(block_on_floor(linear + "    discretisation: node\n", flight(6e-3, 240)));
    double first = 0, last = 0, deepest = 0, dt = 6e-3 / 240;
    for (const support::RunStep& step : run.steps) {
        deepest = std::max(deepest, step.pairs[0].penetration);
        if (!(step.pairs[0].normal > 0)) continue;
        if (first == 0) first = step.time - dt;
        last = step.time;
    }
    EXPECT_NEAR(last - first, std::numbers::pi / omega, 2 * dt);
    EXPECT_NEAR(deepest, v0 / omega, 1e-3 * v0 / omega); // (omega dt)^2 / 24 and the elasticity of the bodies
}

TEST(SoftImpact, LosesWhatADashpotTakes) {
    // no tension [Schwager and Poeschel 2007]
    for (const double zeta : {0.05, 0.3}) {
        const double c = 2 * zeta * m * omega / A, root = std::sqrt(1 - zeta * zeta);
        const double until = std::numbers::pi - std::atan(2 * zeta * root / (1 - 2 * zeta * zeta));
        const double restitution = std::exp(-zeta / root * until);
        const auto run = solved(block_on_floor(
            linear + "    discretisation: node\n    damping: " + std::to_string(c) + " Pa s/m\n", flight(6e-3, 240)));
        EXPECT_NEAR(velocity(run).z(), restitution * v0, 4e-3)
            << zeta; // of the first force, c v0, a step is off by half
        const time::Ledger& end = run.steps.back().ledger;
        const double start = 0.5 * m * v0 * v0;
        EXPECT_NEAR(end.damping, (1 - restitution * restitution) * start, 8e-3 * start);
        EXPECT_NEAR(end.contact, 0, 1e-8 * start);
    }
}

TEST(SoftImpact, IsOfSecondOrderInTime) {
    // ends in the middle of the contact
    const auto depth = [](int steps) {
        const auto run = solved(block_on_floor(linear + "    discretisation: node\n", flight(1.2e-3, steps)));
        return run.steps.back().pairs[0].penetration;
    };
    const double fine = depth(960), one = std::abs(depth(60) - fine), two = std::abs(depth(120) - fine);
    EXPECT_LT(two, 0.35 * one);
}

TEST(SoftImpact, NeedsNoSettingsOfTheStep) {
    // From fifteen steps a contact to a contact of a seventh of a step, which steps are cut for. With 1e12 the interface is as
    // stiff as the block: a tenth of the energy vibrates in it, and rho_inf 0.8 damps what steps do not resolve.
    for (const char* stiffness : {"1e8 N/m^3", "1e10 N/m^3", "1e12 N/m^3"}) {
        const auto run =
            solved(block_on_floor("    pressure_overclosure: {linear: {stiffness: " + std::string(stiffness) + "}}\n",
                                  "stages:\n  flight: {analysis: {dynamic: {}}, duration: 6 ms, steps: 30}\n"));
        const time::Ledger& end = run.steps.back().ledger;
        EXPECT_NEAR(end.kinetic + end.strain, 0.5 * m * v0 * v0, 0.05 * m * v0 * v0) << stiffness;
    }
}

TEST(SoftImpact, CountsAChangeOfTheLawAsWorkFromOutside) {
    // half of what the spring stores at 1.9 rad of its swing is taken away, or as much is given
    const double h = v0 / omega * std::sin(1.9), stored = 0.5 * k * A * h * h;
    for (const double factor : {0.5, 1.5}) {
        const auto run = solved(block_on_floor(
            linear + "    discretisation: node\n",
            flight(2e-3, 80) +
                "  then: {analysis: {dynamic: {integrator: {generalised_alpha: {rho_inf: 1}}}}, duration: 4 ms, "
                "steps: 160, pressure_overclosure: {joint: {linear: {stiffness: " +
                std::to_string(factor * k) + "}}}}\n"));
        const time::Ledger& end = run.steps.back().ledger;
        EXPECT_NEAR(end.external, (factor - 1) * stored, 2e-3 * stored); // the block's elasticity and (omega dt)^2 / 12
        EXPECT_NEAR(end.kinetic + end.strain, 0.5 * m * v0 * v0 + end.external, 1e-5);
        EXPECT_NEAR(end.contact, 0, 1e-5);
    }
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
