/// Interfaces that give way: pressure over overclosure, friction over elastic slip, forces on nodes.

#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

constexpr double E = 1e9, h = 0.02, K = 2e10, k = 5e9; // Pa, m, Pa/m
constexpr double p = 1e6, mu = 0.5, area = 0.01;

/// Two plates of 0.1 m x 0.1 m x h, nu = 0: one-dimensional under pressure.
/// @param divisions  of the lower one; those of the upper one are 4
std::string plates(int divisions, const std::string& pair, const std::string& loads) {
    const std::string n = std::to_string(divisions);
    return R"(
bodies:
  lower: {mesh: {block: {size: [0.1 m, 0.1 m, 0.02 m], divisions: [)" +
           n + ", " + n + R"(, 1]}}, material: {linear_elastic: {E: 1 GPa, nu: 0}}}
  upper:
    mesh: {block: {origin: [0 m, 0 m, 0.02 m], size: [0.1 m, 0.1 m, 0.02 m], divisions: [4, 4, 1]}}
    material: {linear_elastic: {E: 1 GPa, nu: 0}}
sets:
  bottom: {body: lower, surface: z_min}
  crest: {body: lower, surface: z_max}
  base: {body: upper, surface: z_min}
  top: {body: upper, surface: z_max}
supports:
  bottom: {fix: [x, y, z]}
contact:
  joint:
    slave: base
    master: {set: crest, surface: facets}
)" + pair + loads;
}

Vec3 mean_displacement(const support::SceneRun& run, const char* set) {
    Vec3 sum = Vec3::Zero();
    for (const model::Set& one : run.plan.model.sets)
        if (one.name == set)
            for (const Index node : one.nodes)
                sum += run.steps.back().state.u[static_cast<std::size_t>(node)] / static_cast<double>(one.nodes.size());
    return sum;
}

support::SceneRun solved(const std::string& text) {
    support::SceneRun run;
    support::run_scene(run, support::scene_file("soft.yaml", text));
    return run;
}

class SoftContact : public testing::TestWithParam<const char*> {
protected:
    [[nodiscard]] static std::string pair(const std::string& rest) {
        return std::string("    discretisation: ") + GetParam() + "\n" + rest;
    }
};

const std::string linear = "    pressure_overclosure: {linear: {stiffness: 2e10 N/m^3}}\n";

TEST_P(SoftContact, GivesWayByPressureOverStiffness) {
    // means over facets pass the patch test where meshes do not match
    const int divisions = std::string(GetParam()) == "node" ? 4 : 3;
    const auto run =
        solved(plates(divisions, pair(linear),
                      "stages:\n  press: {displacement: {top: {x: 0 m, y: 0 m}}, pressure: {top: 1 MPa}, steps: 2}\n"));
    constexpr double tolerance = 1e-7; // a hundred times the solver's
    const double depth = p / K, shorter = p / E * h;
    EXPECT_NEAR(mean_displacement(run, "top").z(), -2 * shorter - depth, tolerance * depth);
    EXPECT_NEAR(mean_displacement(run, "base").z(), -shorter - depth, tolerance * depth);
    double worst = 0;
    for (const Vec3& u : run.steps.back().state.u) worst = std::max(worst, std::abs(u.x()));
    EXPECT_LT(worst, tolerance * depth) << "a uniform pressure";
}

const std::string press =
    "stages:\n  press: {displacement: {top: {x: 0 m, y: 0 m}}, pressure: {top: 1 MPa}, steps: 2}\n";

TEST_P(SoftContact, FollowsAnExponential) {
    // p = p0 100^(h/c0) is 1 MPa for p0 = 0.1 MPa at h = c0/2
    const auto run = solved(
        plates(4, pair("    pressure_overclosure: {exponential: {pressure: 0.1 MPa, clearance: 50 um}}\n"), press));
    const double depth = 25e-6, shorter = p / E * h;
    EXPECT_NEAR(mean_displacement(run, "base").z(), -shorter - depth, 1e-6 * depth);
}

TEST_P(SoftContact, CarriesAcrossAGapWithinItsClearance) {
    // 1 MPa is a tenth of p0: h = -c0/2
    const auto run = solved(
        plates(4, pair("    pressure_overclosure: {exponential: {pressure: 10 MPa, clearance: 50 um}}\n"), press));
    const double gap = 25e-6, shorter = p / E * h;
    EXPECT_NEAR(mean_displacement(run, "base").z(), -shorter + gap, 1e-6 * gap);
}

TEST_P(SoftContact, FollowsATable) {
    const auto run = solved(plates(
        4, pair("    pressure_overclosure: {tabular: {table: [[-10 um, 0 Pa], [0 um, 0.5 MPa], [20 um, 1.5 MPa]]}}\n"),
        press));
    const double depth = 10e-6, shorter = p / E * h;
    EXPECT_NEAR(mean_displacement(run, "base").z(), -shorter - depth, 1e-6 * depth);
}

TEST_P(SoftContact, HasTheLawOfItsStage) {
    const auto run = solved(plates(4, pair(linear),
                                   press + "  harder: {pressure_overclosure: {joint: {exponential: {pressure: 0.1 MPa, "
                                           "clearance: 50 um}}}, steps: 2}\n"));
    const double depth = 25e-6, shorter = p / E * h;
    EXPECT_NEAR(mean_displacement(run, "base").z(), -shorter - depth, 1e-6 * depth);
}

TEST_P(SoftContact, IsExactWithoutALaw) {
    const auto run =
        solved(plates(4, pair("    pressure_overclosure: exact\n"),
                      "stages:\n  press: {displacement: {top: {x: 0 m, y: 0 m}}, pressure: {top: 1 MPa}}\n"));
    const double shorter = p / E * h;
    EXPECT_NEAR(mean_displacement(run, "top").z(), -2 * shorter, 1e-7 * shorter);
}

TEST_P(SoftContact, SlipsElasticallyUpToCoulombsBound) {
    const std::string law = pair(linear + "    friction: 0.5\n    stick_stiffness: 5e9 N/m^3\n");
    const auto sheared = [&](const char* way) {
        return solved(
            plates(4, law,
                   std::string("stages:\n  press: {displacement: {top: {x: 0 m, y: 0 m}}, pressure: {top: 1 MPa}}\n"
                               "  shear: {displacement: {top: {x: ") +
                       way + "}}, steps: 4}\n"));
    };
    constexpr double tolerance = 5e-5; // of the area slips over the edge: 5 um of 0.1 m
    const auto stuck = sheared("5 um"), slid = sheared("1 mm");
    const Field none(stuck.plan.model.X.size());
    const model::ContactEvaluation& joint = stuck.contact[0];
    double springs = 0;
    for (Index j = 0; j < joint.pair().size(); ++j)
        springs += k * joint.area(j) * joint.drift(j, none.values(), stuck.steps.back().state.u.values()).x();
    EXPECT_GT(springs, 0.01 * mu * p * area);
    EXPECT_LT(springs, 0.5 * mu * p * area);
    EXPECT_NEAR(stuck.steps.back().pairs[0].on_slave.x(), -springs, tolerance * springs);
    constexpr double turn = p / E; // of facets, by strains
    EXPECT_NEAR(slid.steps.back().pairs[0].friction, mu * p * area, turn * mu * p * area);
}

INSTANTIATE_TEST_SUITE_P(Discretisations, SoftContact, testing::Values("node", "petrov_galerkin", "mortar"),
                         [](const auto& one) { return std::string(one.param); });

TEST(SoftContactOfAPart, IsAsSoftAsTheAreaThatIsCovered) {
    // nearly rigid: 1 kN on 36 cm^2 of a grid of 10/3 cm
    const auto run = solved(R"(
bodies:
  block: {mesh: {block: {size: [0.1 m, 0.1 m, 0.02 m], divisions: [3, 3, 1]}}, material: {linear_elastic: {E: 1e13 Pa, nu: 0}}}
  punch:
    mesh: {block: {origin: [0.02 m, 0.02 m, 0.02 m], size: [0.06 m, 0.06 m, 0.02 m]}}
    material: {linear_elastic: {E: 1e13 Pa, nu: 0}}
sets:
  bottom: {body: block, surface: z_min}
  crest: {body: block, surface: z_max}
  base: {body: punch, surface: z_min}
  top: {body: punch, surface: z_max}
supports:
  bottom: {fix: [x, y, z]}
  top: {fix: [x, y]}
stages:
  press: {nodal_force: {top: [0 N, 0 N, -250 N]}}
contact:
  joint:
    slave: crest
    master: {set: base}
    pressure_overclosure: {linear: {stiffness: 2e10 N/m^3}}
    discretisation: petrov_galerkin
)");
    const double depth = 1000 / (K * 0.06 * 0.06);
    EXPECT_NEAR(mean_displacement(run, "base").z(), -depth, 0.01 * depth);
}

TEST(NodalForce, BendsACantileverLikeItsPressure) {
    const auto tip = [](const std::string& load) {
        const auto run = solved(R"(
bodies:
  beam: {mesh: {block: {size: [1 m, 0.1 m, 0.1 m], divisions: [8, 1, 1]}}, material: {linear_elastic: {E: 1 GPa, nu: 0.3}}}
sets:
  root: {body: beam, surface: x_min}
  end: {body: beam, surface: x_max}
  side: {body: beam, surface: z_max}
supports:
  root: {fix: [x, y, z]}
)" + load);
        return mean_displacement(run, "end");
    };
    // 4 nodes of a face of 0.01 m^2 that carry 25 N each
    const Vec3 pulled = tip("stages:\n  load: {pressure: {end: -10 kPa}}\n"),
               by_nodes = tip("stages:\n  load: {nodal_force: {end: [25 N, 0 N, 0 N]}}\n");
    EXPECT_NEAR((pulled - by_nodes).norm(), 0, 1e-9 * pulled.norm());
    const Vec3 bent = tip("stages:\n  load: {nodal_force: {end: [0 N, 0 N, -1 N]}, steps: 2}\n");
    const Vec3 course =
        tip("stages:\n  load: {nodal_force: {end: [0 N, 0 N, {table: [[0 s, 0 N], [1 s, -1 N]]}]}, steps: 2}\n");
    EXPECT_LT(bent.z(), 0);
    EXPECT_NEAR((bent - course).norm(), 0, 1e-9 * bent.norm());
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
