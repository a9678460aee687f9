/// What single keys of a scene do, where no other test shows it.

#include "osculate/core/error.hpp"
#include "osculate/scene/writer.hpp"
#include "scenes/program.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <gmock/gmock.h>
#include <set>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

using testing::HasSubstr;

constexpr double round_off = 1e-12; // relative to sizes and displacements of about 1

mesh::Mesh mesh_of(const std::string& keys) {
    const std::string text = "bodies: {b: {mesh: " + keys + ", material: {linear_elastic: {E: 1 Pa, nu: 0}}}}\n" +
                             "stages: {rest: {steps: 2}}\n";
    return app::build_meshes(scene::parse_scene(text, "mesh.yaml")).front();
}

void expect_box(const mesh::Mesh& mesh, const Vec3& low, const Vec3& high) {
    Eigen::AlignedBox3d box;
    for (const Vec3& x : mesh.nodes) box.extend(x);
    EXPECT_LT((box.min() - low).norm(), round_off * high.norm()) << box.min().transpose();
    EXPECT_LT((box.max() - high).norm(), round_off * high.norm()) << box.max().transpose();
}

/// Distinct values of a coordinate, those of a node line counted once.
std::vector<double> lines(const mesh::Mesh& mesh, int axis) {
    std::vector<double> all;
    for (const Vec3& x : mesh.nodes) all.push_back(x[axis]);
    std::ranges::sort(all);
    const auto rest = std::ranges::unique(all, [](double a, double b) { return b - a < round_off; });
    all.erase(rest.begin(), rest.end());
    return all;
}

TEST(MeshKeys, ContactorStandsWhereItsSizesSay) {
    const mesh::Mesh mesh = mesh_of("{contactor: {radius: 5 m, width: 2 m, length: 3 m, height: 0.5 m, rear: -1 m, "
                                    "divisions: [4, 2, 1], element: tet10}}");
    expect_box(mesh, {-1, -1, -5}, {1, 2, -4.5});
    EXPECT_EQ(mesh.blocks.front().type, mesh::CellType::tet10);
}

TEST(MeshKeys, SerendipityHexahedraHaveNoOtherNodes) {
    // corners and edges of 4 x 2 x 1 and 8 x 2 x 1 elements, and of one
    for (const auto& [text, nodes] :
         {std::pair{
              "{contactor: {radius: 5 m, width: 2 m, length: 3 m, height: 0.5 m, rear: -1 m, divisions: [4, 2, 1], "
              "element: hex20}}",
              5 * 3 * 2 + 4 * 3 * 2 + 5 * 2 * 2 + 5 * 3},
          std::pair{
              "{half_tube: {inner_radius: 2 m, thickness: 0.5 m, length: 3 m, divisions: [8, 2, 1], element: hex20}}",
              9 * 3 * 2 + 8 * 3 * 2 + 9 * 2 * 2 + 9 * 3},
          std::pair{"{block: {size: [1 m, 2 m, 3 m], divisions: [1, 1, 1], element: hex20}}", 20}}) {
        const mesh::Mesh mesh = mesh_of(text);
        EXPECT_EQ(mesh.blocks.front().type, mesh::CellType::hex20);
        EXPECT_EQ(mesh.node_count(), nodes) << text;
    }
}

TEST(MeshKeys, SerendipityWedgesHaveNodesOnTheirDiagonalsBeside) {
    // those of hexahedra, and one for each diagonal of the faces that are cut
    for (const auto& [text, nodes] :
         {std::pair{
              "{contactor: {radius: 5 m, width: 2 m, length: 3 m, height: 0.5 m, rear: -1 m, divisions: [4, 2, 1], "
              "element: wedge15}}",
              5 * 3 * 2 + 4 * 3 * 2 + 5 * 2 * 2 + 5 * 3 + 4 * 2 * 2},
          std::pair{
              "{half_tube: {inner_radius: 2 m, thickness: 0.5 m, length: 3 m, divisions: [8, 2, 1], element: wedge15}}",
              9 * 3 * 2 + 8 * 3 * 2 + 9 * 2 * 2 + 9 * 3 + 8 * 2 * 2}}) {
        const mesh::Mesh mesh = mesh_of(text);
        EXPECT_EQ(mesh.blocks.front().type, mesh::CellType::wedge15);
        EXPECT_EQ(mesh.node_count(), nodes) << text;
    }
}

TEST(MeshKeys, HalfTubeHasItsRadii) {
    const mesh::Mesh mesh = mesh_of(
        "{half_tube: {inner_radius: 2 m, thickness: 0.5 m, length: 3 m, divisions: [8, 2, 1], element: tet10}}");
    expect_box(mesh, {-2.5, 0, -2.5}, {2.5, 3, 0});
    EXPECT_EQ(mesh.blocks.front().type, mesh::CellType::tet10);
    for (const mesh::Facet& facet : mesh.surfaces.at("inner"))
        for (const Index node : facet) {
            const Vec3& x = mesh.nodes[static_cast<std::size_t>(node)];
            EXPECT_NEAR(std::hypot(x.x(), x.z()), 2, round_off);
        }
}

TEST(MeshKeys, HalvesOfRoundBodiesAreCutAtX) {
    const mesh::Mesh tube =
        mesh_of("{tube: {inner_radius: 1 m, thickness: 0.5 m, length: 2 m, divisions: [8, 1, 1], portion: half}}");
    expect_box(tube, {0, -1.5, 0}, {1.5, 1.5, 2});
    const mesh::Mesh cylinder =
        mesh_of("{cylinder: {radius: 2 m, length: 3 m, divisions: [4, 2, 2], portion: half, grading: 2}}");
    expect_box(cylinder, {0, -2, 0}, {2, 2, 3});
    EXPECT_THAT(lines(cylinder, 2), testing::Pointwise(testing::DoubleNear(round_off), {0., 1., 3.}));
}

TEST(MeshKeys, FocusActsOnItsAxesAroundItsPoint) {
    const mesh::Mesh mesh = mesh_of("{block: {size: [4 m, 2 m, 1 m], divisions: [4, 2, 1], "
                                    "focus: {point: [0 m, 0.5 m, 0 m], size: 0.1 m, extent: 0.2 m, axes: [y]}}}");
    EXPECT_EQ(lines(mesh, 0).size(), 5u);
    EXPECT_EQ(lines(mesh, 2).size(), 2u);
    const std::vector<double> y = lines(mesh, 1);
    const auto at = std::ranges::find_if(y, [](double v) { return std::abs(v - 0.5) < round_off; });
    ASSERT_TRUE(at != y.end() && at != y.begin());
    EXPECT_LE(*(at + 1) - *at, 0.1 + round_off);
    EXPECT_LE(*at - *(at - 1), 0.1 + round_off);
    EXPECT_GT(y.back() - y[y.size() - 2], 0.2) << "far from the point elements grow";
}

TEST(MeshKeys, CrownAlongXIsACylinder) {
    const mesh::Mesh mesh =
        mesh_of("{block: {size: [4 m, 2 m, 1 m], divisions: [2, 8, 1], focus: {point: [0 m, 1 m, 0 m]}, "
                "crown: {radius: 3 m, along: x}}}");
    std::set<Index> underside;
    for (const mesh::Facet& facet : mesh.surfaces.at("z_min")) underside.insert(facet.begin(), facet.end());
    for (const Index node : underside) {
        const Vec3& x = mesh.nodes[static_cast<std::size_t>(node)];
        EXPECT_NEAR(x.z(), 3 - std::sqrt(9 - (x.y() - 1) * (x.y() - 1)), round_off);
    }
    expect_box(mesh, {0, 0, 0}, {4, 2, 1});
}

TEST(MeshKeys, ScaleComesBeforeTheTranslation) {
    expect_box(
        mesh_of("{block: {origin: [1 m, 0 m, 0 m], size: [1 m, 2 m, 3 m]}, scale: 2, translate: [0 m, 1 m, 0 m]}"),
        {2, 1, 0}, {4, 5, 6});
}

/// Displacement of the end of one element that was compressed and let go: a single degree of freedom.
std::vector<double> oscillation(const std::string& analysis, int steps) {
    support::SceneRun run;
    support::run_scene(run, support::scene_file("oscillator.yaml", R"(
bodies:
  bar:
    mesh: {block: {size: [1 m, 1 m, 1 m]}}
    material: {linear_elastic: {E: 1 Pa, nu: 0, density: 1 kg/m^3}}
sets:
  clamped: {body: bar, surface: x_max}
  tip: {body: bar, surface: x_min}
supports:
  clamped: {fix: [x, y, z]}
stages:
  compress: {analysis: static, pressure: {tip: 0.1 Pa}}
  swing:
    analysis: )" + analysis + R"(
    duration: 4 s
    steps: )" + std::to_string(steps) + R"(
    ramp: step
    pressure: {tip: 0 Pa}
)"));
    std::vector<double> u;
    for (std::size_t k = 0; k < run.steps.size(); ++k) {
        double sum = 0;
        for (std::size_t i = 0; i < run.plan.model.X.size(); ++i)
            if (run.plan.model.X[i].x() < 0.5) sum += run.steps[k].state.u[i].x() / 4;
        u.push_back(sum);
    }
    return u;
}

/// Newmark's method, mass m and damping a m, k = 1: u'' + a u' + u/m = 0 from rest at u0.
std::vector<double> newmark(double m, double a, double beta, double gamma, int steps) {
    const double dt = 4.0 / steps;
    double u = 0.1, v = 0, w = -u / m;
    std::vector<double> all{u};
    for (int k = 0; k < steps; ++k) {
        const double u1 = u + dt * v + dt * dt * (0.5 - beta) * w, v1 = v + dt * (1 - gamma) * w;
        w = -(a * v1 + u1 / m) / (1 + a * gamma * dt + beta * dt * dt / m);
        u = u1 + beta * dt * dt * w;
        v = v1 + gamma * dt * w;
        all.push_back(u);
    }
    return all;
}

// The mass at the end of a bar of mass 1: a third if consistent, a half if lumped.
TEST(DynamicKeys, OneElementFollowsNewmarksFormulas) {
    const auto expect = [](const std::string& keys, const std::vector<double>& exact) {
        const int steps = static_cast<int>(exact.size()) - 1;
        const std::vector<double> u = oscillation(keys, steps);
        ASSERT_EQ(u.size(), exact.size());
        const double solver = 1e-8; // residuals of 1e-9, over the steps
        for (std::size_t k = 0; k < u.size(); ++k) EXPECT_NEAR(u[k], exact[k], solver) << keys << ", step " << k;
    };
    expect("{dynamic: {integrator: {newmark: {beta: 0.3025, gamma: 0.6}}}}", newmark(1.0 / 3, 0, 0.3025, 0.6, 20));
    expect("{dynamic: {integrator: {newmark: {}}, mass: lumped}}", newmark(0.5, 0, 0.25, 0.5, 20));
    expect("{dynamic: {integrator: {newmark: {}}, mass_damping: 0.4 Hz}}", newmark(1.0 / 3, 0.4, 0.25, 0.5, 20));
}

/// A contactor pressed into a coarse tube, and pushed on.
support::SceneRun pressed_tube(const std::string& surface) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("paper/half_tube.yaml"),
                       {{"bodies.tube.mesh.half_tube.divisions", "[7, 6, 1]"},
                        {"bodies.contactor.mesh.contactor.divisions", "[4, 5, 1]"},
                        {"stages.slide.steps", "2"},
                        {"stages.slide.duration", "2"},
                        {"stages.slide.displacement.rear.y", "0.6 m"},
                        {"contact.sliding.surface", surface}});
    return run;
}

class SurfaceKeys : public testing::TestWithParam<std::pair<const char*, const char*>> {};

/// The load is carried whatever the surface; which node carries what depends on it.
TEST_P(SurfaceKeys, ChangeTheSurfaceAndNotTheLoad) {
    const auto [surface, other] = GetParam();
    const auto a = pressed_tube(surface), b = pressed_tube(other);
    const auto &x = a.steps.back(), &y = b.steps.back();
    const double load = std::abs(x.pairs[0].on_slave.z());
    const double solver = 1e-7; // residuals of 1e-9 of the step's reference force, at every node
    EXPECT_NEAR(x.pairs[0].on_slave.z(), y.pairs[0].on_slave.z(), solver * load);
    double difference = 0;
    for (std::size_t j = 0; j < x.state.contact[0].lambda.size(); ++j)
        difference = std::max(difference, (x.state.contact[0].lambda[j] - y.state.contact[0].lambda[j]).norm());
    EXPECT_GT(difference, 10 * solver * load) << "the key does nothing";
    EXPECT_LT(difference, load / 3) << "both are the same tube";
}

INSTANTIATE_TEST_SUITE_P(
    All, SurfaceKeys,
    testing::Values(std::pair{"{facets: {}}", "{facets: {hysteresis: 0.9}}"},
                    std::pair{"{rpim: {}}", "{rpim: {hysteresis: 0.9}}"}, std::pair{"{rpim: {}}", "{rpim: {R: 1}}"},
                    std::pair{"{rpim: {}}", "{rpim: {q: 0.5}}"},
                    std::pair{"{rpim: {basis: multiquadric}}", "{rpim: {basis: r3}}"},
                    std::pair{"{rpim: {}}", "{rpim: {basis: r5}}"}, std::pair{"{blend: {}}", "{blend: {R: 1}}"},
                    std::pair{"{blend: {}}", "{blend: {q: 0.5}}"}, std::pair{"{blend: {}}", "{blend: {m: 3}}"},
                    std::pair{"{blend: {basis: multiquadric}}", "{blend: {basis: r3}}"},
                    std::pair{"{blend: {}}", "{blend: {basis: r5}}"},
                    std::pair{"{blend: {}}", "{blend: {coordinates: tangential}}"}));

class Keys : public Program {};

/// The cap of press.yaml sunk into its base, whose facets are 0.5 m long.
TEST_F(Keys, InitialOverlapLimitIsOfTheFacetSize) {
    const std::string press = scene_file("tests/scenes/press.yaml");
    const auto check = [&](double sunk, const std::string& limit) {
        return osculate({"check", press, "--set",
                         "bodies.cap.mesh.block.origin=[0.3, 0.45, " + std::to_string(1 - sunk) + "]", "--set",
                         "contact.joint.initial_overlap_limit=" + limit});
    };
    EXPECT_EQ(check(0.09, "0.2").code, 0);
    EXPECT_EQ(check(0.11, "0.2").code, 2);
    EXPECT_EQ(check(0.02, "0.05").code, 0);
    const Outcome refused = check(0.03, "0.05");
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("overlap by less than 0.05 of the facet size"));
}

/// However far: beyond some depth no node is near enough to a surface for contact to see it.
TEST_F(Keys, GeneralContactRefusesBodiesThatAreInsideOneAnother) {
    const std::string press = scene_file("tests/scenes/press.yaml");
    for (const double sunk : {0.02, 0.3, 0.6, 0.8}) {
        const Outcome checked =
            osculate({"check", press, "--set", "contact={general: {}}", "--set",
                      "bodies.cap.mesh.block.origin=[0.3, 0.45, " + std::to_string(1 - sunk) + "]"});
        EXPECT_EQ(checked.code, sunk < 0.05 ? 0 : 2) << sunk << '\n' << checked.err;
        if (checked.code != 0) {
            EXPECT_THAT(checked.err, HasSubstr("contact.general: expected bodies that ")) << sunk;
        }
    }
}

TEST_F(Keys, DescriptionAndFieldsReachTheFiles) {
    const auto files =
        run(scene_file("tests/scenes/press.yaml"), {"description=Pressed, then pulled.", "output.slave_fields=[area]"});
    EXPECT_THAT(content(files / "scene.yaml"), HasSubstr("description: \"Pressed, then pulled.\""));
    EXPECT_THAT(content(files / "frames/joint.slave_00001.vtp"), HasSubstr("Name=\"area\""));
}

/// After the cuts of an impact the step comes back by the factor of `growth`, and no faster.
TEST_F(Keys, GrowthIsTheLargestFactorBetweenSteps) {
    for (const double growth : {1.5, 3.0}) {
        const Csv steps(run(scene_file("configs/validation/falling_block.yaml"),
                            {"stages.fall.duration=0.4", "stages.fall.steps=40",
                             "stages.fall.control.growth=" + std::to_string(growth)}) /
                        "steps.csv");
        double largest = 0, before = 0;
        for (std::size_t i = 0; i < steps.rows.size(); ++i) {
            if (steps.text(i, "verdict") != "accept") continue;
            if (before > 0) largest = std::max(largest, steps.number(i, "dt") / before);
            before = steps.number(i, "dt");
        }
        EXPECT_NEAR(largest, growth, 1e-6) << "written with 6 digits or more";
    }
}

/// A block that contact and friction alone hold: springs stand in until they do.
TEST_F(Keys, StabilisationHoldsWhatOnlyContactWillHold) {
    const std::string scene = scene_file("configs/extreme/held_by_contact.yaml");
    EXPECT_EQ(osculate({"run", scene, "-o", "with", "--quiet"}).code, 0);
    const Outcome without = osculate({"run", scene, "-o", "without", "--quiet", "--set", "solver.stabilisation=false"});
    EXPECT_EQ(without.code, 3);
    EXPECT_THAT(without.err, HasSubstr("block"));
}

TEST_F(Keys, EnergyGrowthIsJudgedByItsLimit) {
    const auto fall = [&](const std::string& scene, const std::string& change, const std::string& limit) {
        return osculate({"run", scene_file(scene), "-o", "run", "--force", "--set", change, "--set",
                         "expect.energy_growth=" + limit})
            .err;
    };
    EXPECT_THAT(fall("configs/validation/falling_block.yaml", "stages.fall.steps=200", "1e-6"),
                HasSubstr("\nas expected\n"))
        << "round-off of the ledger";
    // an overlap at the start is all of the energy
    EXPECT_THAT(fall("configs/extreme/overlap_dynamic.yaml", "output.template=minimal", "0.5"),
                HasSubstr("not as expected: energy growth "));
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
