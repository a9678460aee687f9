/// Quadratic hexahedra bend without locking.

#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

using support::scene_file;

/// Deflection of the end of a clamped beam, over that of Timoshenko's beam.
double deflection(const std::vector<scene::Override>& elements) {
    support::SceneRun found;
    support::run_scene(found, scene_file("beam.yaml", R"(
bodies:
  beam:
    mesh: {block: {size: [10 m, 1 m, 1 m], divisions: [5, 2, 2]}}
    material: {linear_elastic: {E: 1 GPa, nu: 0.3}}
sets:
  wall: {body: beam, surface: x_min}
supports:
  wall: {fix: [x, y, z]}
stages:
  bend: {body_force: {beam: [0 N/m^3, 0 N/m^3, 1 kN/m^3]}}
)"),
                       elements);
    // q L^4 / 8 E I + q L^2 / 2 k G A
    constexpr double q = 1e3, L = 10, E = 1e9, I = 1.0 / 12, G = E / 2.6, k = 5.0 / 6;
    return largest_component(found.steps.back().state.u) / (q * L * L * L * L / (8 * E * I) + q * L * L / (2 * k * G));
}

TEST(Hex20Beam, BendsWithFewElements) {
    EXPECT_NEAR(deflection({{"bodies.beam.mesh.block.element", "hex20"}, {"bodies.beam.hex_formulation", "reduced"}}),
                1, 0.02);
    EXPECT_NEAR(deflection({{"bodies.beam.mesh.block.element", "hex20"}}), 1, 0.04);
    EXPECT_LT(deflection({}), 0.75) << "which locks";
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
