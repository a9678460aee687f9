/// Pressure on faces of ten-node tetrahedra: the patch test of surface loads.

#include "osculate/core/error.hpp"
#include "osculate/fe/facet_quadrature.hpp"
#include "osculate/fe/reference_element.hpp"
#include "osculate/mesh/generators.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <random>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

const char* const pressed_block = R"(
name: pressed_block
bodies:
  block:
    mesh: {block: {size: [2 m, 2 m, 1 m], divisions: [3, 3, 2], element: tet10}}
    material: {linear_elastic: {E: 1 GPa, nu: 0.3}}
sets:
  bed: {body: block, surface: z_min}
  left: {body: block, surface: x_min}
  front: {body: block, surface: y_min}
  top: {body: block, surface: z_max}
supports:
  bed: {fix: [z]}
  left: {fix: [x]}
  front: {fix: [y]}
stages:
  press: {pressure: {top: 1 MPa}}
solver: {tolerance: 1.0e-12}
output: {template: minimal}
)";

/// Moves the corners of all elements, those on sides of the block along these; edges stay straight.
void shake(std::vector<mesh::Mesh>& meshes) {
    constexpr double by = 0.12; // m, elements are 0.5 m and more
    const Vec3 size(2, 2, 1);
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-by, by);
    for (mesh::Mesh& mesh : meshes) {
        const std::vector<Vec3> before = mesh.nodes;
        for (std::size_t i = 0; i < before.size(); ++i)
            for (int k = 0; k < 3; ++k)
                if (before[i](k) > 1e-9 && before[i](k) < size(k) - 1e-9) mesh.nodes[i](k) += uniform(random);
        const mesh::ElementBlock& tets = mesh.blocks.front();
        for (Index e = 0; e < tets.size(); ++e) {
            const Index* cell = tets.connectivity.data() + 10 * static_cast<std::ptrdiff_t>(e);
            for (int m = 0; m < 6; ++m)
                mesh.nodes[cell[4 + m]] =
                    (mesh.nodes[cell[fe::Tet10::edges[m][0]]] + mesh.nodes[cell[fe::Tet10::edges[m][1]]]) / 2;
        }
    }
}

TEST(PressureOnTet10, IsTheStressOfAnIrregularMeshAtEveryNode) {
    constexpr double p = 1e6, E = 1e9, round_off = 1e-9;
    support::SceneRun run;
    support::run_scene(run, support::scene_file("pressed_block.yaml", pressed_block), {}, shake);
    const auto& model = run.plan.model;
    const auto& u = run.steps.back().state.u;
    const auto stress = model::nodal_stress(model, 0, run.steps.back().state);
    for (Index i = 0; i < model.nodes(); ++i) {
        EXPECT_NEAR(stress(i, 2), -p, round_off * p);
        for (const int k : {0, 1, 3, 4, 5}) EXPECT_NEAR(stress(i, k), 0, round_off * p);
        EXPECT_NEAR(u[i].z(), -p / E * model.X[i].z(), round_off * p / E) << "the top moves by p h/E";
    }
}

TEST(PressureOnTet10, ThatFollowsIsTheStressOfAnIrregularMeshToo) {
    constexpr double p = 1e6, round_off = 1e-9;
    support::SceneRun run;
    support::run_scene(run, support::scene_file("followed_block.yaml", pressed_block),
                       {{"stages.press", "{follower_pressure: {top: 1 MPa}}"},
                        {"bodies.block.material", "{neo_hookean: {E: 10 MPa, nu: 0.3}}"}},
                       shake);
    const auto& model = run.plan.model;
    const auto stress = model::nodal_stress(model, 0, run.steps.back().state);
    for (Index i = 0; i < model.nodes(); ++i) EXPECT_NEAR(stress(i, 2), -p, round_off * p) << "Cauchy's";
    for (const auto& step : run.steps) EXPECT_LE(step.iterations, 6) << "Newton with the exact tangent";
}

TEST(PressureOnTet10, OnPartOfAFaceHasTheResultantOfThatPart) {
    // 2 m x 2 m, three elements a side: the box ends in the middle of the second row
    support::SceneRun run;
    support::run_scene(run, support::scene_file("part_of_block.yaml", pressed_block),
                       {{"sets.top", "{body: block, box: {min: [0, 0, 1 m], max: [1 m, 2 m, 1 m]}}"}});
    EXPECT_NEAR(run.steps.back().load.z(), -2e6, 1e-9 * 2e6);
    const auto& model = run.plan.model;
    Vec3 moment = Vec3::Zero();
    const Field force = run.plan.stages.back().force(model.X.size(), 1);
    for (std::size_t i = 0; i < force.size(); ++i) moment += model.X[i].cross(force[i]);
    EXPECT_NEAR(moment.x(), -2e6 * 1, 1e-9 * 2e6);
    EXPECT_NEAR(moment.y(), 2e6 * 0.5, 1e-9 * 2e6);
}

TEST(PressureOnTet10, InATubeOfCurvedFacesPushesAsOnItsTrueBore) {
    // a half-tube's bore, radius 3 m, 12 m long: p D L downwards is exact when the ends of the arc lie on the diameter, as the
    // integral of n dA depends on the rim alone
    const mesh::Mesh tube = mesh::make_half_tube(3, 1, 12, {8, 2, 1}, mesh::CellType::tet10);
    Vec3 force = Vec3::Zero();
    double area = 0;
    for (const mesh::SurfaceFace& face : mesh::surface_faces(tube, tube.surfaces.at("inner"))) {
        for (const Vec3& f : fe::pressure_forces(face, tube.nodes, 1)) force += f;
        area += fe::area(face, tube.nodes);
    }
    EXPECT_NEAR(force.z(), -6.0 * 12, 1e-11);
    const double exact = 3.14159265358979323846 * 3 * 12;
    EXPECT_NEAR(area, exact, 1e-4 * exact); // the four-triangle facets miss 16 chords' 1.6e-3
}

// ---- contact is refused -----------------------------------------------------------------------------------------------

const char* const two_blocks = R"(
name: two_blocks
bodies:
  lower:
    mesh: {block: {size: [2 m, 2 m, 1 m], divisions: [2, 2, 1]}}
    material: {linear_elastic: {E: 1 GPa, nu: 0.3}}
  upper:
    mesh: {block: {origin: [0, 0, 1 m], size: [2 m, 2 m, 1 m], divisions: [2, 2, 1]}}
    material: {linear_elastic: {E: 1 GPa, nu: 0.3}}
sets:
  bed: {body: lower, surface: z_min}
  ground: {body: lower, surface: z_max}
  under: {body: upper, surface: z_min}
  top: {body: upper, surface: z_max}
supports:
  bed: {fix: [x, y, z]}
  top: {fix: [x, y]}
contact:
  touch: {slave: under, master: {set: ground}}
stages:
  press: {pressure: {top: 1 MPa}}
)";

std::vector<Fault> faults_with(const std::vector<scene::Override>& overrides) {
    const scene::Scene scene = scene::read_scene(support::scene_file("two_blocks.yaml", two_blocks), overrides);
    Timings timings;
    try {
        (void)app::compile(scene, app::build_meshes(scene), 1, timings);
    } catch (const SceneError& error) {
        return error.faults();
    }
    return {};
}

TEST(ContactOfTet10, IsTakenOnEitherSide) {
    EXPECT_TRUE(faults_with({}).empty());
    for (const char* body : {"upper", "lower"})
        EXPECT_TRUE(faults_with({{"bodies." + std::string(body) + ".mesh.block.element", "tet10"}}).empty());
}

TEST(ContactOfTet10, IsNoneWhereOtherFacesOfTheBodyTouchNothing) {
    EXPECT_TRUE(
        faults_with(
            {{"bodies.upper.mesh.block.element", "tet10"}, {"contact", "{}"}, {"supports.top", "{fix: [x, y, z]}"}})
            .empty());
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
