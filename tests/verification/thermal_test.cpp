/// Bodies that change their temperature.

#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace osculate {
namespace {

constexpr double alpha = 1e-3, nu = 0.3, E = 10e6; // an expansion large enough to tell large from small strain

std::string block(const std::string& element, const std::string& law, const std::string& supports,
                  const std::string& stages) {
    return R"(
bodies:
  block:
    mesh: {block: {size: [2 m, 1 m, 1 m], divisions: [3, 2, 2], element: )" +
           element + "}}\n    material: {" + law +
           R"(: {E: 10 MPa, nu: 0.3, density: 1000 kg/m^3, expansion: 1.0e-3 1/K}}
sets:
  x: {body: block, surface: x_min}
  y: {body: block, surface: y_min}
  z: {body: block, surface: z_min}
  right: {body: block, surface: x_max}
  front: {body: block, surface: y_max}
  top: {body: block, surface: z_max}
supports:
  x: {fix: [x]}
  y: {fix: [y]}
  z: {fix: [z]}
)" + supports +
           "stages:\n" + stages;
}

std::unique_ptr<support::SceneRun> run(const std::string& text) {
    auto found = std::make_unique<support::SceneRun>();
    support::run_scene(*found, support::scene_file("thermal.yaml", text));
    return found;
}
double largest_stress(const support::SceneRun& run) {
    return model::nodal_stress(run.plan.model, 0, run.steps.back().state).cwiseAbs().maxCoeff();
}
const char* const laws[] = {"linear_elastic", "saint_venant_kirchhoff", "neo_hookean"};

TEST(Thermal, AFreeBlockGrowsWithoutStress) {
    for (const char* element : {"hex8", "tet10", "hex20"})
        for (const char* law : laws) {
            const auto found = run(block(element, law, "", "  heat: {steps: 2, temperature: {block: 50 K}}\n"));
            const model::State& state = found->steps.back().state;
            for (std::size_t i = 0; i < state.u.size(); ++i)
                EXPECT_LT((state.u[i] - 50 * alpha * found->plan.model.X[i]).norm(), 1e-9) << element << law;
            EXPECT_LT(largest_stress(*found), 1e-7 * E * 50 * alpha) << element << law;
            EXPECT_NEAR((found->steps.front().state.u.values().back() / 25 - state.u.values().back() / 50).norm(), 0,
                        1e-10)
                << "it is ramped";
        }
}

TEST(Thermal, AHeldBlockHasTheStressOfItsStrain) {
    // small strain, held on all sides: -E alpha T / (1 - 2 nu) in all directions
    const auto found =
        run(block("hex8", "linear_elastic", "  right: {fix: [x]}\n  front: {fix: [y]}\n  top: {fix: [z]}\n",
                  "  heat: {temperature: {block: 50 K}}\n"));
    const auto stress = model::nodal_stress(found->plan.model, 0, found->steps.back().state);
    const double expected = -E * alpha * 50 / (1 - 2 * nu);
    EXPECT_LT((stress.leftCols(3).array() - expected).abs().maxCoeff(), 1e-9 * std::abs(expected));
    EXPECT_LT(stress.rightCols(3).cwiseAbs().maxCoeff(), 1e-9 * std::abs(expected));
}

TEST(Thermal, AStageKeepsTheTemperatureOfTheOneBefore) {
    const auto found =
        run(block("hex8", "neo_hookean", "",
                  "  heat: {temperature: {block: 50 K}}\n  stay: {}\n  cool: {temperature: {block: 0 K}}\n"));
    const auto& top = [&](std::size_t step) { return found->steps.at(step).state.u.values().back(); };
    EXPECT_LT((top(1) - top(0)).norm(), 1e-9);
    EXPECT_LT(top(2).norm(), 1e-9);
}

TEST(Thermal, AGradientBendsABarToItsCircle) {
    // a linear temperature across the height of a free bar calls up no stress: curvature alpha dT/dz, by quadratic elements
    std::string text = block("hex20", "linear_elastic", "", "  heat: {temperature: {lower: -10 K, top: 10 K}}\n");
    const auto at = text.find("divisions: [3, 2, 2]");
    text.replace(at, 20, "divisions: [6, 1, 1]");
    text.replace(text.find("  right:"), 0, "  lower: {body: block, surface: z_min}\n");
    const auto z = text.find("  z: {fix: [z]}\n");
    text.replace(z, 16, "  edge: {fix: [z]}\n");
    text.replace(text.find("  right:"), 0,
                 "  edge: {body: block, box: {min: [-1 mm, -1 mm, -1 mm], max: [1 mm, 1 mm, 1 mm]}}\n");
    const auto found = run(text);
    const auto& X = found->plan.model.X;
    const auto& u = found->steps.back().state.u;
    for (std::size_t i = 0; i < u.size(); ++i) { // u_z of the axis less that of its start
        if (std::abs(X[i].z() - 0.5) > 1e-9) continue;
        double start = 0;
        for (std::size_t k = 0; k < u.size(); ++k)
            if (X[k].x() == 0 && std::abs(X[k].z() - X[i].z()) < 1e-9 && std::abs(X[k].y() - X[i].y()) < 1e-9)
                start = u[k].z();
        EXPECT_NEAR(u[i].z() - start, -20 * alpha * X[i].x() * X[i].x() / 2, 1e-9);
    }
}

} // namespace
} // namespace osculate
