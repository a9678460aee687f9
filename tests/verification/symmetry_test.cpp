/// Half and quarter models give the answer of the full model.

#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <map>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

/// A plate pressed on a soft block; whole, halved at x = 0, or quartered
/// at x = 0 and y = 0, with the same mesh lines.
std::string scene(bool half_x, bool half_y) {
    const double x0 = half_x ? 0 : -2, y0 = half_y ? 0 : -2;
    const int nx = half_x ? 4 : 8, ny = half_y ? 3 : 6;
    std::string text;
    const auto block = [&](const char* name, double z, double h, double inset, int mx, int my, int mz, double E) {
        const double ax = half_x ? 0 : x0 + inset, ay = half_y ? 0 : y0 + inset;
        const double wx = (half_x ? 1 : 2) * (2 - inset), wy = (half_y ? 1 : 2) * (2 - inset);
        text += std::string("  ") + name + ":\n    mesh: {block: {origin: [" + std::to_string(ax) + ", " +
                std::to_string(ay) + ", " + std::to_string(z) + "], size: [" + std::to_string(wx) + ", " +
                std::to_string(wy) + ", " + std::to_string(h) + "], divisions: [" + std::to_string(mx) + ", " +
                std::to_string(my) + ", " + std::to_string(mz) +
                "]}}\n    material: {linear_elastic: {E: " + std::to_string(E) + ", nu: 0.3}}\n";
    };
    text += "bodies:\n";
    block("soil", -1, 1, 0, nx, ny, 2, 1e6);
    block("plate", 0, 0.3, 0.75, half_x ? 3 : 6, half_y ? 3 : 6, 1, 1e7);
    text += R"(sets:
  bed: {body: soil, surface: z_min}
  ground: {body: soil, surface: z_max}
  under: {body: plate, surface: z_min}
  top: {body: plate, surface: z_max}
)";
    std::string supports = "supports:\n  bed: {fix: [x, y, z]}\n";
    for (const char* body : {"soil", "plate"}) {
        if (half_x) {
            text += std::string("  ") + body + "_x: {body: " + body + ", surface: x_min}\n";
            supports += std::string("  ") + body + "_x: {symmetry: [1, 0, 0]}\n";
        }
        if (half_y) {
            text += std::string("  ") + body + "_y: {body: " + body + ", surface: y_min}\n";
            supports += std::string("  ") + body + "_y: {symmetry: [0, 1, 0]}\n";
        }
    }
    return text + supports + R"(contact:
  base: {slave: under, master: {set: ground, surface: facets}, friction: 0.2}
stages:
  load: {pressure: {top: 100 kPa}}
solver: {tolerance: 1.0e-10}
)";
}

using Displacements = std::map<std::array<long, 4>, Vec3>; // by body and position in micrometres

struct Pairing {
    const char* surface;
    const char* discretisation;
};
std::ostream& operator<<(std::ostream& out, const Pairing& p) {
    return out << p.surface << ", " << p.discretisation;
}

Displacements solve(const Pairing& pairing, bool half_x, bool half_y) {
    const std::string path = support::scene_file("symmetry.yaml", scene(half_x, half_y));
    support::SceneRun run;
    support::run_scene(
        run, path,
        {{"contact.base.surface", pairing.surface}, {"contact.base.discretisation", pairing.discretisation}});
    Displacements u;
    for (std::size_t b = 0; b < run.plan.model.bodies.size(); ++b) {
        const model::Body& body = run.plan.model.bodies[b];
        for (Index i = 0; i < body.nodes(); ++i) {
            const Vec3 X = body.mesh.nodes[i] * 1e6;
            u[{static_cast<long>(b), std::lround(X.x()), std::lround(X.y()), std::lround(X.z())}] =
                run.steps.back().state.u[body.first_node + i];
        }
    }
    return u;
}

class Symmetry : public testing::TestWithParam<Pairing> {};

TEST_P(Symmetry, HalfAndQuarterModelsGiveTheFullAnswer) {
    const Displacements full = solve(GetParam(), false, false);
    double largest = 0;
    for (const auto& [where, u] : full) largest = std::max(largest, u.norm());
    for (const bool quarter : {false, true}) {
        const Displacements part = solve(GetParam(), true, quarter);
        double worst = 0;
        for (const auto& [where, u] : part) worst = std::max(worst, (u - full.at(where)).norm());
        EXPECT_LT(worst, 1e-7 * largest) << (quarter ? "quarter" : "half"); // the solver's tolerance, amplified
    }
}

INSTANTIATE_TEST_SUITE_P(Masters, Symmetry,
                         testing::Values(Pairing{"facets", "node"}, Pairing{"blend", "node"},
                                         Pairing{"facets", "mortar"}, Pairing{"blend", "mortar"},
                                         Pairing{"blend", "petrov_galerkin"}));
// rpim takes sides where a node lies on a mesh line. So do facets, which nodes notice if drifts are averages

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
