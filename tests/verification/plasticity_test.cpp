/// Bodies that yield.

#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

constexpr double E = 200e9, first = 200e6, slope = 1e9;

const std::string bar = R"(
bodies:
  bar:
    mesh: {block: {size: [10 mm, 2 mm, 2 mm], divisions: [3, 1, 1]}}
    material:
      elastic_plastic: {E: 200 GPa, nu: 0.3, density: 7850 kg/m^3, yield_stress: {table: [[0, 200 MPa], [1, 1200 MPa]]}}
sets:
  left: {body: bar, surface: x_min}
  right: {body: bar, surface: x_max}
  y: {body: bar, surface: y_min}
  z: {body: bar, surface: z_min}
supports:
  left: {fix: [x]}
  y: {fix: [y]}
  z: {fix: [z]}
stages:
  pull: {steps: 2, displacement: {right: {x: 1 mm}}}
  back: {displacement: {right: {x: 0.99 mm}}}
output:
  body_fields: [displacement, plastic_strain]
  probes:
    middle: {point: {body: bar, at: [5 mm, 1 mm, 1 mm], fields: [plastic_strain]}}
    axis: {line: {body: bar, from: [0, 1 mm, 1 mm], to: [9 mm, 1 mm, 1 mm], samples: 3, fields: [plastic_strain]}}
    end: {nodes: {set: right, fields: [plastic_strain], reduce: [max]}}
)";

std::unique_ptr<support::SceneRun> run(const std::vector<scene::Override>& overrides) {
    auto found = std::make_unique<support::SceneRun>();
    support::run_scene(*found, support::scene_file("bar.yaml", bar), overrides);
    return found;
}
double axial_stress(const support::SceneRun& run, std::size_t step) {
    const auto stress = model::nodal_stress(run.plan.model, 0, run.steps.at(step).state);
    EXPECT_LT((stress.col(0).array() - stress(0, 0)).abs().maxCoeff(), 1e-6 * std::abs(stress(0, 0))) << "uniform";
    return stress(0, 0);
}

TEST(Plasticity, ABarFollowsItsHardeningCurveAndSpringsBackElastically) {
    // Kirchhoff stress t = first + slope a, logarithmic strain e = t/E + a; volume changes by exp((1 - 2 nu) t/E)
    for (const auto& [element, formulation] : {std::pair{"hex8", "full"}, std::pair{"hex8", "b_bar"},
                                               std::pair{"hex20", "reduced"}, std::pair{"tet10", "full"}}) {
        const auto found =
            run({{"bodies.bar.mesh.block.element", element}, {"bodies.bar.hex_formulation", formulation}});
        const auto kirchhoff = [&](std::size_t step, double nominal) {
            return axial_stress(*found, step) * std::exp(0.4 * nominal / E);
        };
        const double a = (std::log(1.1) - first / E) / (1 + slope / E), t = first + slope * a;
        EXPECT_NEAR(kirchhoff(1, t) / t, 1, 1e-7) << element << formulation;
        const double unloaded = t - E * std::log(1.1 / 1.099);
        EXPECT_NEAR(kirchhoff(2, unloaded) / unloaded, 1, 1e-6) << element << formulation;
    }
}

TEST(Plasticity, WorkOfABarIsStoredOrDissipated) {
    // a weight that falls onto the bar's end is caught by flow: momentum is gone, and the ledger knows where the energy is
    const auto found = run({{"stages", R"({throw: {analysis: {dynamic: {integrator: {generalised_alpha: {rho_inf: 1}}}},
                                                duration: 20 us, steps: 40,
                                                displacement: {right: {x: {expression: "100*t", unit: m}}}}})"}});
    const time::Ledger &start = found->steps.front().ledger, &end = found->steps.back().ledger;
    const double scale = end.external;
    EXPECT_GT(end.damping, 0.05 * scale) << "flow dissipates";
    EXPECT_LT(std::abs(end.balance - start.balance), 1e-8 * scale);
    EXPECT_LT(std::abs(end.algorithmic), 0.05 * scale) << "what flows is the integrator's to second order only";
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
