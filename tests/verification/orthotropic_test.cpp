/// Bodies with three axes of their own.

#include "osculate/core/error.hpp"
#include "osculate/material/orthotropic.hpp"
#include "osculate/material/voigt.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <Eigen/LU>
#include <cmath>
#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

const std::string plank = R"(
bodies:
  plank:
    mesh: {block: {size: [2 m, 1 m, 1 m], divisions: [3, 2, 2]}}
    material:
      orthotropic:
        E: [12 MPa, 1 MPa, 0.5 MPa]
        nu: [0.4, 0.35, 0.3]
        G: [0.9 MPa, 0.8 MPa, 0.1 MPa]
        axes: [[1, 1, 0], [-1, 1, 0.5]]
        density: 500 kg/m^3
        expansion: 1.0e-5 1/K
sets:
  x: {body: plank, surface: x_min}
  right: {body: plank, surface: x_max}
  origin: {body: plank, box: {min: [-1 mm, -1 mm, -1 mm], max: [1 mm, 1 mm, 1 mm]}}
  up: {body: plank, box: {min: [-1 mm, -1 mm, 0.99 m], max: [1 mm, 1 mm, 1.01 m]}}
supports:
  x: {fix: [x]}
  origin: {fix: [y, z]}
  up: {fix: [y]}
stages:
  pull: {pressure: {right: -1 kPa}}
)";

std::unique_ptr<support::SceneRun> run(const std::vector<scene::Override>& overrides) {
    auto found = std::make_unique<support::SceneRun>();
    support::run_scene(*found, support::scene_file("plank.yaml", plank), overrides);
    return found;
}

TEST(OrthotropicPlank, StretchesAlongItsAxesUnderUniformStress) {
    // a uniform stress along an axis of the material, which is that of the plank: its strains are the compliances
    for (const char* element : {"hex8", "tet4", "hex20"}) {
        const auto found = run({{"bodies.plank.material.orthotropic.axes", "[[0, 1, 0], [1, 0, 0]]"},
                                {"bodies.plank.mesh.block.element", element}});
        const auto& X = found->plan.model.X;
        const auto& u = found->steps.back().state.u;
        const double E1 = 12e6, E2 = 1e6, p = 1e3; // x is the second axis, y the first, z the third, reversed
        for (std::size_t i = 0; i < u.size(); ++i) {
            const Vec3 expected(p / E2 * X[i].x(), -0.4 / E1 * p * X[i].y(), -0.3 / E2 * p * X[i].z());
            EXPECT_LT((u[i] - expected).norm(), 1e-9 * p / E2) << element;
        }
    }
}

TEST(OrthotropicPlank, WithAxesAtAnAngleHasTheStressOfItsStrains) {
    const auto found = run({{"supports", "{x: {fix: [x, y, z]}, right: {fix: [y, z]}}"},
                            {"stages.pull", "{displacement: {right: {x: 1 mm}}}"}});
    // ends held: not uniform, but forces of internal stress balance reactions to round-off
    double left = 0, right = 0;
    const Field f = model::internal_force(found->plan.model, found->steps.back().state.at_rest(), 1);
    for (std::size_t i = 0; i < f.size(); ++i) {
        const double x = found->plan.model.X[i].x();
        (x == 0 ? left : right) += x == 0 || std::abs(x - 2) < 1e-9 ? f[i].x() : 0;
    }
    EXPECT_GT(right, 0);
    EXPECT_NEAR(left + right, 0, 1e-9 * right);
}

TEST(OrthotropicPlank, OfImpossibleRatiosIsRefused) {
    EXPECT_THROW((void)run({{"bodies.plank.material.orthotropic.nu", "[0.4, 0.35, 1.5]"}}), SceneError);
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
