/// Friction that is higher at rest, and damping of what slides, against closed solutions.

#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

constexpr double m = 1, A = 0.01, g = 10; // kg, m^2, m/s^2

std::string number(double value) {
    return std::to_string(value);
}

/// A block that is stiff and rests on a floor, both without gravity.
std::string block_on_floor(const std::string& rest, double v = 0) {
    return R"(
bodies:
  floor:
    mesh: {block: {origin: [-0.1 m, -0.1 m, -0.1 m], size: [0.6 m, 0.3 m, 0.1 m], divisions: [3, 2, 1]}}
    material: {linear_elastic: {E: 1e9 Pa, nu: 0, density: 1000 kg/m^3}}
  block:
    mesh: {block: {origin: [0 m, 0 m, 0 m], size: [0.1 m, 0.1 m, 0.1 m], divisions: [2, 2, 1]}}
    material: {linear_elastic: {E: 1e9 Pa, nu: 0, density: 1000 kg/m^3}}
    initial_velocity: [)" +
           number(v) + R"( m/s, 0 m/s, 0 m/s]
sets:
  bottom: {body: floor, surface: z_min}
  crest: {body: floor, surface: z_max}
  base: {body: block, surface: z_min}
  top: {body: block, surface: z_max}
supports:
  bottom: {fix: [x, y, z]}
contact:
  joint:
    slave: base
    master: {set: crest, surface: facets}
)" + rest;
}

using Changes = std::vector<scene::Override>;

support::SceneRun solved(const std::string& text, const Changes& changes) {
    support::SceneRun run;
    support::run_scene(run, support::scene_file("friction_laws.yaml", text), changes);
    return run;
}

Changes together(Changes changes, const Changes& more) {
    changes.insert(changes.end(), more.begin(), more.end());
    return changes;
}

Vec3 mean(const support::SceneRun& run, const Field& field) {
    const model::Body& block = run.plan.model.bodies[1];
    Vec3 sum = Vec3::Zero();
    for (Index i = 0; i < block.nodes(); ++i) sum += field[block.first_node + i] / block.nodes();
    return sum;
}

const Changes two_coefficients{{"contact.joint.friction", "0.3"}, {"contact.joint.static_friction", "0.4"}};
const Changes at_nodes{{"contact.joint.discretisation", "node"}};

TEST(StaticFriction, HoldsUntilItsBoundAndFallsToTheKineticOneOnceItSlides) {
    // pressed by 1 kN and drawn; some nodes slide before others, and some that the fall relieves stick again
    constexpr double N = 1000;
    const std::string stages = "stages:\n"
                               "  press: {duration: 1 s, steps: 1, pressure: {top: 100 kPa}, "
                               "displacement: {top: {x: 0 m, y: 0 m}}}\n"
                               "  draw: {duration: 1 s, steps: 40, pressure: {top: 100 kPa}, "
                               "displacement: {top: {x: 40 um, y: 0 m}}}\n";
    for (const char* discretisation : {"node", "mortar", "petrov_galerkin"}) {
        const Changes changes = together(two_coefficients, {{"contact.joint.discretisation", discretisation}});
        const auto run = solved(block_on_floor(stages), changes);
        ASSERT_EQ(run.steps.size(), 41u);
        double most = 0;
        for (const support::RunStep& step : run.steps) {
            const double drawn = -step.pairs[0].on_slave.x();
            EXPECT_LT(drawn, 0.4 * N * (1 + 1e-9));
            most = std::max(most, drawn);
        }
        EXPECT_GT(most, 0.35 * N) << discretisation; // not all nodes are at their bounds at the same time
        EXPECT_NEAR(-run.steps.back().pairs[0].on_slave.x(), 0.3 * N, 1e-3 * N) << discretisation;
    }
}

std::string stage(const char* name, double along, const char* ramp) {
    return std::string("  ") + name +
           ": {analysis: {dynamic: {stiffness_damping: 1e-4 s}}, duration: 0.2 s, steps: 200, ramp: " + ramp +
           ", body_force: {block: [" + number(1000 * along) + ", 0, " + number(-1000 * g) + "]}}\n";
}
/// A block that has settled, or one in motion, on a slope.
std::string raised(double tangent) {
    return "stages:\n" + stage("settle", 0, "step") + stage("raise", g * tangent, "linear");
}
std::string on_slope(double tangent) {
    return "stages:\n" + stage("go", g * tangent, "step");
}

TEST(StaticFriction, HoldsABlockOnASlopeThatASlidingOneGoesDown) {
    // tan A between the coefficients
    const Changes changes = together(two_coefficients, at_nodes);
    const auto rests = solved(block_on_floor(raised(0.35)), changes);
    EXPECT_LT(mean(rests, rests.steps.back().state.u).norm(), 1e-6);
    const double v0 = 0.5, t = 0.2, v = v0 + (0.35 - 0.3) * g * t;
    const auto slides = solved(block_on_floor(on_slope(0.35), v0), changes);
    EXPECT_NEAR(mean(slides, slides.steps.back().state.v).x(), v, 0.01 * v);
    EXPECT_NEAR(slides.steps.back().ledger.friction, 0.3 * m * g * (v0 + v) / 2 * t, 0.02 * m);
}

TEST(StaticFriction, TakesABlockThatHasComeToRest) {
    // it stops at v0^2 / (2 mu g) and stays, though the slope becomes steeper than kinetic friction holds
    const std::string stages = raised(0.35);
    const double v0 = 0.15, path = v0 * v0 / (2 * 0.3 * g);
    const auto pair = solved(block_on_floor(stages, v0), together(two_coefficients, at_nodes));
    const auto general = solved(block_on_floor(stages, v0), {{"contact", "{general: {}}"},
                                                             {"contact.general.friction", "0.3"},
                                                             {"contact.general.static_friction", "0.4"}});
    const auto by_rule =
        solved(block_on_floor(stages, v0), {{"contact", "{general: {}}"},
                                            {"contact.general.pairs", "{rule: {between: [floor, block]}}"},
                                            {"contact.general.pairs.rule.friction", "0.3"},
                                            {"contact.general.pairs.rule.static_friction", "0.4"}});
    for (const auto* run : {&pair, &general, &by_rule}) {
        // in its first step it has the friction of rest: 0.001 m/s less
        EXPECT_NEAR(mean(*run, run->steps.back().state.u).x(), path, 0.02 * path);
        EXPECT_LT(std::abs(mean(*run, run->steps.back().state.v).x()), 1e-6);
    }
}

TEST(TangentialDamping, SlowsWhatSlidesAsADashpotDoes) {
    // m v' = -mu m g - d A v, small enough to leave all of the base on the floor
    constexpr double T = 0.2, v0 = 1, rate = 100 * A / m;
    const std::string stages = on_slope(0);
    for (const char* discretisation : {"node", "petrov_galerkin"})
        for (const double mu : {0.0, 0.2}) {
            const auto run = solved(block_on_floor(stages, v0), {{"contact.joint.discretisation", discretisation},
                                                                 {"contact.joint.friction", number(mu)},
                                                                 {"contact.joint.tangential_damping", "100 Pa s/m"}});
            const double level = mu * g / rate, exact = (v0 + level) * std::exp(-rate * T) - level;
            EXPECT_NEAR(mean(run, run.steps.back().state.v).x(), exact, 5e-3 * v0) << mu;
            const time::Ledger& end = run.steps.back().ledger;
            EXPECT_NEAR(end.friction, 0.5 * m * (v0 * v0 - exact * exact), 1e-2 * m);
        }
}

TEST(TangentialDamping, LeavesWhatSticksInPlace) {
    const auto run = solved(
        block_on_floor(raised(0.35)),
        together(at_nodes, {{"contact.joint.friction", "0.5"}, {"contact.joint.tangential_damping", "500 Pa s/m"}}));
    EXPECT_LT(mean(run, run.steps.back().state.u).norm(), 1e-6);
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
