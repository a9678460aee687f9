/// With couplings too the tangent of the whole step problem is the derivative of its residual, as a matrix and as
/// products.

#include "support/step_tangent.hpp"

#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

struct Case {
    const char* name;
    const char* analysis = "static";
    const char* fix = "[]";
    const char* follower = "{}";
    const char* material = "neo_hookean";
    const char* coupled = "cap"; ///< cap: above; sole: slave nodes among them; ground: masters among them
};

std::ostream& operator<<(std::ostream& out, const Case& c) {
    return out << c.name;
}

std::string block_on_ground(const Case& c) {
    return R"(
bodies:
  ground:
    mesh: {block: {origin: [-0.2, -0.2, -0.2], size: [0.9, 0.8, 0.2], divisions: [3, 3, 1]}}
    material: {)" +
           std::string(c.material) + R"(: {E: 1 MPa, nu: 0.3, density: 1000}}
  block:
    mesh: {block: {size: [0.5, 0.4, 0.3], divisions: [3, 2, 2]}, rotate: {axis: [0, 0, 1], angle: 0.2}}
    material: {)" +
           c.material + R"(: {E: 1 MPa, nu: 0.3, density: 1000}}
sets:
  bottom: {body: ground, surface: z_min}
  floor: {body: ground, surface: z_max}
  sole_all: {body: block, surface: z_min}
  cap: {body: block, surface: z_max}
  sole: {body: block, box: {min: [-0.2, -0.2, -0.1], max: [0.2, 0.6, 0.1]}}
  land: {body: ground, box: {min: [-0.3, -0.3, -0.1], max: [0.2, 0.2, 0.1]}}
supports:
  bottom: {fix: [x, y, z]}
couplings:
  head: {set: )" +
           c.coupled + ", reference_point: [0.2, 0.1, 0.5], fix: " + c.fix + R"(}
contact:
  touch: {slave: sole_all, master: {set: floor, surface: facets}, friction: 0.3, discretisation: node}
stages:
  press:
    analysis: )" +
           c.analysis + R"(
    duration: 0.1 s
    steps: 10
    follower_pressure: )" +
           c.follower + "\n";
}

class CouplingTangent : public testing::TestWithParam<Case> {};

TEST_P(CouplingTangent, IsTheDerivativeOfTheResidual) {
    support::expect_exact_tangent(block_on_ground(GetParam()));
}

const char* const dynamic = "{dynamic: {integrator: {generalised_alpha: {rho_inf: 0.5}}}}";

INSTANTIATE_TEST_SUITE_P(All, CouplingTangent,
                         testing::Values(Case{"statics"}, Case{"dynamics", dynamic}, Case{"held", dynamic, "[x, rz]"},
                                         Case{"follower", dynamic, "[]", "{cap: 500 kPa, floor: 100 kPa}"},
                                         Case{"linear", dynamic, "[]", "{}", "linear_elastic"},
                                         Case{"slaves", dynamic, "[]", "{sole_all: 10 kPa}", "neo_hookean", "sole"},
                                         Case{"masters", dynamic, "[]", "{}", "neo_hookean", "land"}),
                         [](const auto& parameter) { return std::string(parameter.param.name); });

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
