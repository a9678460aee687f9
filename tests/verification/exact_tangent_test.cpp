/// With exact surfaces as masters the tangent of the whole step problem is the derivative of its residual.

#include "support/step_tangent.hpp"

#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

struct Case {
    const char* name;
    const char* surface;
    bool dynamic = false;
    const char* fix = "[]";
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
    return out << c.name;
}

/// A block whose underside is some mm above or inside the surface, near the origin.
std::string block_on(const Case& c) {
    return R"(
bodies:
  block:
    mesh: {block: {origin: [-0.2, -0.15, 0], size: [0.4, 0.3, 0.2], divisions: [3, 3, 1]}}
    material: {neo_hookean: {E: 1 MPa, nu: 0.3, density: 1000}}
  tool:
    rigid_surface: {)" +
           std::string(c.surface) + R"(}
    rigid: {mass: 3, inertia: [0.3, 0.2, 0.4], products: [0.01, 0.02, 0.03], reference_point: [0.1, 0.05, -0.2], centre: [0.15, 0, -0.3], fix: )" +
           c.fix + R"(}
sets:
  sole: {body: block, surface: z_min}
  top: {body: block, surface: z_max}
contact:
  touch: {slave: sole, master: {rigid_surface: tool}, friction: 0.3, initial_overlap_limit: 1}
stages:
  press:
    analysis: )" +
           (c.dynamic ? "{dynamic: {integrator: {generalised_alpha: {rho_inf: 0.5}}}}" : "static") + R"(
    duration: 0.1 s
    steps: 10
)";
}

class ExactTangent : public testing::TestWithParam<Case> {};

TEST_P(ExactTangent, IsTheDerivativeOfTheResidual) {
    support::expect_exact_tangent(block_on(GetParam()), 0.02);
}

constexpr const char* profile =
    "extruded: {points: [[-0.5, 0, 0.05], [-0.1, 0, -0.01], [0.1, 0, 0.01], [0.5, 0, -0.04]], "
    "direction: [0.1, 1, 0.05], outward: [0, 0, 1], ";

const std::string filleted = std::string(profile) + "fillet: 0.3}", smooth = std::string(profile) + "smooth: true}";

INSTANTIATE_TEST_SUITE_P(
    All, ExactTangent,
    testing::Values(
        Case{"plane", "plane: {point: [0, 0, 0], normal: [0.05, -0.1, 1]}"},
        Case{"plane_in_dynamics", "plane: {point: [0, 0, 0], normal: [0.05, -0.1, 1]}", true},
        Case{"held", "sphere: {centre: [0, 0, -0.5], radius: 0.5}", true, "[x, rz]"},
        Case{"sphere", "sphere: {centre: [0, 0, -0.5], radius: 0.5}"},
        Case{"hollow", "sphere: {centre: [0, 0, 0.8], radius: 0.83, inside: true}", true},
        Case{"cylinder", "cylinder: {axis_point: [0, 0, -0.4], axis_direction: [1, 1, 0.1], radius: 0.4}", true},
        Case{"bore", "cylinder: {axis_point: [0, 0, 0.6], axis_direction: [1, 0.2, 0], radius: 0.62, inside: true}"},
        Case{"cone", "cone: {apex: [0.5, 0, 0.1], axis_direction: [-1, 0, -0.6], half_angle: 0.4}", true},
        Case{"funnel",
             "cone: {apex: [-3, 0, -0.02], axis_direction: [0.98, 0, 0.1987], half_angle: 0.2, inside: true}"},
        Case{"profile", filleted.c_str(), true}, Case{"curve", smooth.c_str()}),
    [](const auto& parameter) { return std::string(parameter.param.name); });

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
