/// Ties: joined bodies are as one.

#include "osculate/core/error.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <gmock/gmock.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

using support::scene_file;
using support::with;

/// Two blocks one on the other whose meshes do not match, the upper one turned about the vertical by nothing, and pressed.
const std::string blocks = R"(
bodies:
  below:
    mesh: {block: {size: [2 m, 1 m, 1 m], divisions: [3, 2, 2], element: BELOW}}
    material: {LAW: {E: 10 MPa, nu: 0.3}}
  above:
    mesh: {block: {origin: [0 m, 0 m, 1 m], size: [2 m, 1 m, 0.5 m], divisions: [5, 3, 1], element: ELEMENT}}
    material: {LAW: {E: 10 MPa, nu: 0.3}}
sets:
  x: {body: below, surface: x_min}
  y: {body: below, surface: y_min}
  bed: {body: below, surface: z_min}
  xa: {body: above, surface: x_min}
  ya: {body: above, surface: y_min}
  lower: {body: below, surface: z_max}
  upper: {body: above, surface: z_min}
  top: {body: above, surface: z_max}
supports:
  x: {fix: [x]}
  xa: {fix: [x]}
  y: {fix: [y]}
  ya: {fix: [y]}
  bed: {fix: [z]}
ties:
  glue: {slave: SLAVE, master: MASTER}
stages:
  press: {pressure: {top: 1 MPa}}
)";

std::unique_ptr<support::SceneRun> run(const std::string& text) {
    auto found = std::make_unique<support::SceneRun>();
    support::run_scene(*found, scene_file("tie.yaml", text));
    return found;
}

TEST(Tie, PassesThePatchTestAcrossMeshesThatDoNotMatch) {
    constexpr double p = 1e6, round_off = 1e-9; // of the pressure: residuals are solved to 1e-10 of the loads
    const auto elements = {"hex8", "tet4", "wedge6", "tet10", "wedge15", "hex20"};
    for (const std::string element : elements)
        for (const std::string below : elements)
            for (const bool swapped : {false, true}) {
                const auto found = run(with(blocks, {{"ELEMENT", element},
                                                     {"BELOW", below},
                                                     {"LAW", "linear_elastic"},
                                                     {"SLAVE", swapped ? "lower" : "upper"},
                                                     {"MASTER", swapped ? "upper" : "lower"}}));
                for (Index b = 0; b < 2; ++b) {
                    const auto stress = model::nodal_stress(found->plan.model, b, found->steps.back().state);
                    Matrix expected = Matrix::Zero(stress.rows(), 6);
                    expected.col(2).setConstant(-p);
                    EXPECT_LT((stress - expected).cwiseAbs().maxCoeff(), round_off * p)
                        << element << " on " << below << ", slave " << (swapped ? "below" : "above") << ", body " << b;
                }
            }
}

TEST(Tie, LeavesToSupportsWhatTheyHold) {
    // between walls on all sides, all the nodes of which are held across them: uniaxial strain
    constexpr double p = 1e6, nu = 0.3, round_off = 1e-9;
    const auto found =
        run(with(blocks, {{"  top: {body: above, surface: z_max}",
                           "  top: {body: above, surface: z_max}\n  u: {body: below, surface: x_max}\n  v: {body: "
                           "below, surface: y_max}\n  ua: {body: above, surface: x_max}\n  va: {body: above, "
                           "surface: y_max}"},
                          {"  bed: {fix: [z]}", "  bed: {fix: [z]}\n  u: {fix: [x]}\n  ua: {fix: [x]}\n  v: {fix: "
                                                "[y]}\n  va: {fix: [y]}"},
                          {"ELEMENT", "hex8"},
                          {"BELOW", "hex8"},
                          {"LAW", "linear_elastic"},
                          {"SLAVE", "upper"},
                          {"MASTER", "lower"}}));
    const auto& sets = found->plan.model.sets;
    double across = 0; // of both walls at x = 0, 1.5 m^2
    for (std::size_t s = 0, r = 0; s < sets.size(); ++s) {
        const bool supported = sets[s].name == "x" || sets[s].name == "y" || sets[s].name == "bed" ||
                               sets[s].name == "u" || sets[s].name == "xa" || sets[s].name == "ya" ||
                               sets[s].name == "v" || sets[s].name == "ua" || sets[s].name == "va";
        if (!supported) continue;
        if (sets[s].name == "x" || sets[s].name == "xa") across += found->steps.back().reactions[r].x();
        ++r;
    }
    EXPECT_NEAR(across, nu / (1 - nu) * p * 1.5, round_off * p);
    for (Index b = 0; b < 2; ++b) {
        const auto stress = model::nodal_stress(found->plan.model, b, found->steps.back().state);
        EXPECT_LT((stress.col(2).array() + p).abs().maxCoeff(), round_off * p);
        EXPECT_LT((stress.col(0).array() + nu / (1 - nu) * p).abs().maxCoeff(), round_off * p);
    }
}

/// A cantilever of one piece or of two, bent by its weight; displacement of its end.
/// @param element  with incompatible modes, if it has them
double tip(const std::string& where_it_is_cut, const std::string& element = "hex8") {
    const std::string head = R"(
bodies:
  left:
    mesh: {block: {size: [LEFT m, 1 m, 1 m], divisions: [NLEFT, CUT, CUT], element: ELEMENT}}
    material: &steel {linear_elastic: {E: 1 GPa, nu: 0.3}}
FORMULATION
)";
    const std::string right = R"(
  right:
    mesh: {block: {origin: [5 m, 0 m, 0 m], size: [5 m, 1 m, 1 m], divisions: [NRIGHT, FINE, FINE], element: ELEMENT}}
    material: *steel
FORMULATION
)";
    const bool one = where_it_is_cut.empty();
    const bool linear = element == "hex8";
    const std::string formulation = linear ? "    hex_formulation: incompatible_modes\n" : "";
    std::string text = with(head, {{"NLEFT", linear ? (one ? "20" : "10") : (one ? "10" : "5")},
                                   {"LEFT", one ? "10" : "5"},
                                   {"CUT", linear ? "4" : "3"},
                                   {"ELEMENT", element},
                                   {"FORMULATION\n", formulation}});
    if (!one)
        text += with(right, {{"NRIGHT", linear ? "15" : "7"},
                             {"FINE", linear ? "6" : "5"},
                             {"ELEMENT", element},
                             {"FORMULATION\n", formulation}});
    text += "sets:\n  wall: {body: left, surface: x_min}\n  end: {body: " + std::string(one ? "left" : "right") +
            ", surface: x_max}\n";
    if (!one) text += "  a: {body: left, surface: x_max}\n  b: {body: right, surface: x_min}\n";
    text += "supports:\n  wall: {fix: [x, y, z]}\n" + where_it_is_cut +
            "stages:\n  bend: {body_force: {left: [0 N/m^3, 0 N/m^3, 1 kN/m^3]" +
            std::string(one ? "" : ", right: [0 N/m^3, 0 N/m^3, 1 kN/m^3]") + "}}\n";
    const auto found = run(text);
    const model::Model& m = found->plan.model;
    double sum = 0, count = 0;
    for (std::size_t i = 0; i < m.X.size(); ++i)
        if (m.X[i].x() + m.origin.x() > 10 - 1e-6) {
            sum += found->steps.back().state.u[i].z();
            ++count;
        }
    return sum / count;
}

TEST(Tie, OfTwoHalvesOfABeamBendsAsOnePiece) {
    for (const std::string element : {"hex8", "hex20", "tet10"}) {
        const double whole = tip("", element);
        for (const std::string glue : {"slave: b, master: a", "slave: a, master: b"})
            EXPECT_NEAR(tip("ties:\n  glue: {" + glue + "}\n", element), whole, 1e-3 * whole)
                << element << ": " << glue;
    }
}

TEST(Tie, TurnsWithoutForces) {
    // surfaces that are curved and do not match
    for (const char* element : {"hex8", "tet10", "hex20"}) {
        const auto found = run(with(R"(
bodies:
  tube:
    mesh: {half_tube: {inner_radius: 1 m, thickness: 0.3 m, length: 2 m, divisions: [9, 5, 1], element: ELEMENT}}
    material: {neo_hookean: {E: 1 MPa, nu: 0.3}}
  core:
    mesh: {half_tube: {inner_radius: 0.6 m, thickness: 0.4 m, length: 2 m, divisions: [6, 3, 2], element: ELEMENT}}
    material: {neo_hookean: {E: 1 MPa, nu: 0.3}}
sets:
  outside: {body: tube, surface: outer}
  inside: {body: tube, surface: inner}
  core_outside: {body: core, surface: outer}
couplings:
  hand: {set: outside}
ties:
  glue: {slave: core_outside, master: inside, distance: 20 cm}
stages:
  turn: {steps: 3, motion: {hand: {x: 1 m, rx: 40 deg, ry: 100 deg, rz: 0 deg, y: 0 m, z: 0 m}}}
)",
                                    {{"ELEMENT", element}}));
        const auto& state = found->steps.back().state;
        EXPECT_GT(found->plan.model.ties.front().adjusted, 1e-4);
        EXPECT_GT(largest_component(state.u), 1);
        constexpr double E = 1e6, volume = 5, strain = 5e-8; // to which steps are solved
        EXPECT_LT(model::strain_energy(found->plan.model, state.u, state.material, 1),
                  E * volume * strain * strain / 2);
    }
}

TEST(Tie, RefusesWhatItWouldGetWrong) {
    const auto faults = [](const std::string& text) {
        try {
            (void)run(text);
        } catch (const SceneError& error) {
            std::string all;
            for (const Fault& fault : error.faults())
                all += fault.key + ": " + fault.expected + "; " + fault.found + "\n";
            return all;
        }
        return std::string("none");
    };
    const std::vector<std::pair<std::string, std::string>> usual{
        {"ELEMENT", "hex8"}, {"BELOW", "hex8"}, {"LAW", "linear_elastic"}, {"SLAVE", "upper"}, {"MASTER", "lower"}};
    EXPECT_THAT(faults(with(blocks, {{"MASTER", "top"},
                                     {"ELEMENT", "hex8"},
                                     {"BELOW", "hex8"},
                                     {"LAW", "linear_elastic"},
                                     {"SLAVE", "upper"}})),
                testing::HasSubstr("two surfaces of 'above'"));
    EXPECT_THAT(faults(with(blocks, {{"SLAVE", "top"},
                                     {"ELEMENT", "hex8"},
                                     {"BELOW", "hex8"},
                                     {"LAW", "linear_elastic"},
                                     {"MASTER", "lower"}})),
                testing::HasSubstr("the nearest is 0.5 m from it"));
    EXPECT_THAT(faults(with(blocks, {{"[0 m, 0 m, 1 m]", "[0 m, 0 m, 1.2 m]"},
                                     {"ELEMENT", "hex8"},
                                     {"BELOW", "hex8"},
                                     {"LAW", "linear_elastic"},
                                     {"SLAVE", "upper"},
                                     {"MASTER", "lower"}})),
                testing::HasSubstr("nodes near the master, or a larger `distance`"));
    EXPECT_THAT(faults(with(blocks, {{"MASTER", "MASTER, distance: 2 m"},
                                     {"[0 m, 0 m, 1 m]", "[0 m, 0 m, 0.2 m]"},
                                     {"ELEMENT", "hex8"},
                                     {"BELOW", "hex8"},
                                     {"LAW", "linear_elastic"},
                                     {"SLAVE", "upper"},
                                     {"MASTER", "lower"}})),
                testing::HasSubstr("elements fold where nodes are moved"));
    // one end of the upper block lifted by 0.2 m: half of its nodes are too far
    EXPECT_THAT(
        faults(with(blocks, {{"[5, 3, 1], element: ELEMENT}", "[5, 3, 1]}, rotate: {axis: [0, 1, 0], angle: -8 deg}"},
                             {"  xa: {fix: [x]}\n", ""},
                             {"ELEMENT", "hex8"},
                             {"BELOW", "hex8"},
                             {"LAW", "linear_elastic"},
                             {"SLAVE", "upper"},
                             {"MASTER", "lower"}})),
        testing::HasSubstr("nodes above the master that are more than a quarter of a facet from it"));
    EXPECT_THAT(faults(with(blocks + "  pull: {displacement: {upper: {z: 1 mm}}}\n", usual)),
                testing::HasSubstr("drive the tie's master"));
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
