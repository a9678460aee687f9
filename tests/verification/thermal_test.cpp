/// Bodies that change their temperature.

#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

constexpr double alpha = 1e-3, nu = 0.3, E = 10e6; // an expansion large enough to tell large from small strain

const std::string block = R"(
bodies:
  block:
    mesh: {block: {size: [2 m, 1 m, 1 m], divisions: [3, 2, 2]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0.3, expansion: 1.0e-3 1/K}}
sets:
  x: {body: block, surface: x_min}
  y: {body: block, surface: y_min}
  z: {body: block, surface: z_min}
  right: {body: block, surface: x_max}
  front: {body: block, surface: y_max}
  top: {body: block, surface: z_max}
  edge: {body: block, box: {min: [-1 mm, -1 mm, -1 mm], max: [1 mm, 1 mm, 1 mm]}}
supports:
  x: {fix: [x]}
  y: {fix: [y]}
  z: {fix: [z]}
stages:
  heat: {steps: 2, temperature: {block: 50 K}}
)";

using Overrides = std::vector<scene::Override>;

std::unique_ptr<support::SceneRun> run(const std::string& text, const Overrides& overrides) {
    auto found = std::make_unique<support::SceneRun>();
    support::run_scene(*found, support::scene_file("thermal.yaml", text), overrides);
    return found;
}
const Overrides laws[] = {
    {},
    {{"bodies.block.material", "{saint_venant_kirchhoff: {E: 10 MPa, nu: 0.3, expansion: 1.0e-3 1/K}}"}},
    {{"bodies.block.material", "{neo_hookean: {E: 10 MPa, nu: 0.3, expansion: 1.0e-3 1/K}}"}},
    {{"bodies.block.material",
      "{elastic_plastic: {E: 10 MPa, nu: 0.3, expansion: 1.0e-3 1/K, yield_stress: 10 kPa}}"}}};
double largest_stress(const support::SceneRun& run) {
    return model::nodal_stress(run.plan.model, 0, run.steps.back().state).cwiseAbs().maxCoeff();
}
TEST(Thermal, AFreeBlockGrowsWithoutStress) {
    for (const char* element : {"hex8", "tet10", "wedge15", "hex20"})
        for (std::size_t law = 0; law < std::size(laws); ++law) {
            Overrides all = laws[law];
            all.push_back({"bodies.block.mesh.block.element", element});
            const auto found = run(block, all);
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
    const auto found = run(
        block, {{"supports.right", "{fix: [x]}"}, {"supports.front", "{fix: [y]}"}, {"supports.top", "{fix: [z]}"}});
    const auto stress = model::nodal_stress(found->plan.model, 0, found->steps.back().state);
    const double expected = -E * alpha * 50 / (1 - 2 * nu);
    EXPECT_LT((stress.leftCols(3).array() - expected).abs().maxCoeff(), 1e-9 * std::abs(expected));
    EXPECT_LT(stress.rightCols(3).cwiseAbs().maxCoeff(), 1e-9 * std::abs(expected));
}

TEST(Thermal, AStageKeepsTheTemperatureOfTheOneBefore) {
    Overrides all = laws[2];
    all.push_back({"stages.heat.steps", "1"});
    all.push_back({"stages.stay", "{duration: 2 s}"});
    all.push_back({"stages.cool", "{temperature: {block: 0 K}}"});
    const auto found = run(block, all);
    const auto& top = [&](std::size_t step) { return found->steps.at(step).state.u.values().back(); };
    EXPECT_GT(top(0).norm(), 0.05);
    EXPECT_LT((top(1) - top(0)).norm(), 1e-9);
    EXPECT_LT(top(2).norm(), 1e-9);
}

TEST(Thermal, AGradientBendsABarToItsCircle) {
    // a linear temperature across the height of a free bar calls up no stress: curvature alpha dT/dz, by quadratic elements
    const auto found = run(block, {{"bodies.block.mesh.block.element", "hex20"},
                                   {"bodies.block.mesh.block.divisions", "[6, 1, 1]"},
                                   {"supports", "{x: {fix: [x]}, y: {fix: [y]}, edge: {fix: [z]}}"},
                                   {"stages.heat.temperature", "{block: 0 K, z: -10 K, top: 10 K}"}});
    const auto& X = found->plan.model.X;
    const auto& u = found->steps.back().state.u;
    for (std::size_t i = 0; i < u.size(); ++i) { // u_z less that of the bar's start
        if (X[i].z() != 0) continue;
        for (std::size_t k = 0; k < u.size(); ++k)
            if (X[k].x() == 0 && X[k].z() == 0 && X[k].y() == X[i].y()) {
                EXPECT_NEAR(u[i].z() - u[k].z(), -20 * alpha * X[i].x() * X[i].x() / 2, 1e-9);
            }
    }
}

/// A plug that warms up in a ring of the same stiffness, both between walls.
const std::string fit = R"(
bodies:
  plug:
    mesh: {cylinder: {radius: 10 mm, length: 4 mm, divisions: [8, 6, 2]}}
    material: {linear_elastic: {E: 200 GPa, nu: 0.3, expansion: 1.2e-5 1/K}}
  ring:
    mesh: {tube: {inner_radius: 10.001 mm, thickness: 9.999 mm, length: 4 mm, divisions: [36, 2, 8]}}
    material: {linear_elastic: {E: 200 GPa, nu: 0.3}}
sets:
  p0: {body: plug, surface: z_min}
  p1: {body: plug, surface: z_max}
  r0: {body: ring, surface: z_min}
  r1: {body: ring, surface: z_max}
  out: {body: plug, surface: outer}
  in: {body: ring, surface: inner}
  axis: {body: plug, box: {min: [-0.01 mm, -0.01 mm, -1 mm], max: [0.01 mm, 0.01 mm, 5 mm]}}
  plug_x: {body: plug, box: {min: [-1 mm, -0.01 mm, -1 mm], max: [11 mm, 0.01 mm, 5 mm]}}
  ring_x: {body: ring, box: {min: [-21 mm, -0.01 mm, -1 mm], max: [21 mm, 0.01 mm, 5 mm]}}
  ring_y: {body: ring, box: {min: [-0.01 mm, -21 mm, -1 mm], max: [0.01 mm, 21 mm, 5 mm]}}
supports:
  p0: {symmetry: [0, 0, 1]}
  p1: {symmetry: [0, 0, 1]}
  r0: {symmetry: [0, 0, 1]}
  r1: {symmetry: [0, 0, 1]}
  axis: {fix: [x, y]}
  plug_x: {fix: [y]}
  ring_x: {fix: [y]}
  ring_y: {fix: [x]}
contact:
  fit: {slave: in, master: {set: out}, adjust: 2 um}
stages:
  warm: {temperature: {plug: 100 K}}
)";

TEST(Thermal, APlugThatWarmsUpPressesOnItsRingAsLameSays) {
    // plane strain, radii a and b: p ((1+nu)/E) [((1-2nu) a^2 + b^2)/(b^2 - a^2) + (1-2nu)] = (1+nu) alpha T, where the ring's
    // micrometre of play has been adjusted away
    const auto found = run(fit, {});
    const support::PairForces& pair = found->steps.back().pairs[0];
    double area = 0;
    for (const double a : found->plan.model.pairs[0]->slaves().area) area += a;
    const double a2 = 1, b2 = 4, expected = 1.2e-5 * 100 * 200e9 / (((1 - 2 * nu) * a2 + b2) / (b2 - a2) + 1 - 2 * nu);
    EXPECT_NEAR(pair.normal / area / expected, 1, 0.005) << "of elements a tenth of the thickness long";
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
