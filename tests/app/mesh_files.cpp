#include "osculate/app/compile.hpp"
#include "osculate/core/error.hpp"
#include "osculate/core/file_content.hpp"
#include "osculate/mesh/surface_faces.hpp"
#include "osculate/scene/reader.hpp"
#include "osculate/scene/writer.hpp"
#include "support/source_tree.hpp"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <string>
#include <unistd.h>

namespace osculate::app::OSCULATE_THIS_FILE {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

/// Two cubes apart in one file, the second inside out and given twice, and a node that belongs to nothing.
const std::string cubes = "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
                          "11,3,0,0\n12,4,0,0\n13,4,1,0\n14,3,1,0\n15,3,0,1\n16,4,0,1\n17,4,1,1\n18,3,1,1\n99,9,9,9\n"
                          "*ELEMENT, TYPE=C3D8, ELSET=left\n1,1,2,3,4,5,6,7,8\n"
                          "*ELEMENT, TYPE=C3D8, ELSET=right\n2,15,16,17,18,11,12,13,14\n3,15,16,17,18,11,12,13,14\n";

class MeshFilesOfScenes : public ::testing::Test {
protected:
    /// Of this process: tests run side by side.
    std::filesystem::path folder =
        std::filesystem::path(::testing::TempDir()) / ("osculate_mesh_files_of_scenes_" + std::to_string(::getpid()));

    void SetUp() override {
        std::filesystem::create_directories(folder);
        std::filesystem::current_path(folder);
        std::ofstream("cubes.inp") << cubes;
    }
    void TearDown() override {
        std::filesystem::current_path(std::filesystem::temp_directory_path());
        std::filesystem::remove_all(folder);
    }

    static scene::Scene scene_with(const std::string& bodies) {
        return scene::parse_scene("bodies:\n" + bodies + "stages:\n  rest: {}\n", "scene.yaml");
    }
};

TEST_F(MeshFilesOfScenes, BodiesArePartsOfOneFileMendedAsAsked) {
    const scene::Scene scene =
        scene_with("  left:\n    mesh: {file: {path: cubes.inp, part: left, repair: [dangling_nodes]}}\n"
                   "    material: {linear_elastic: {E: 1 MPa, nu: 0.2}}\n"
                   "  right:\n    mesh: {file: {path: cubes.inp, piece: 2, repair: [inverted, "
                   "degenerate, duplicate, dangling_nodes, coincident_nodes, non_manifold, keep_non_manifold]}}\n"
                   "    material: {linear_elastic: {E: 1 MPa, nu: 0.2}}\n");
    std::vector<std::string> notes;
    const auto meshes = build_meshes(scene, &notes);
    EXPECT_EQ(meshes[0].nodes.front(), Vec3(0, 0, 0));
    EXPECT_EQ(meshes[1].nodes.front(), Vec3(3, 0, 0));
    EXPECT_EQ(meshes[1].element_count(), 1);
    EXPECT_THAT(notes, ElementsAre(HasSubstr("body left: "), HasSubstr("dangling nodes left out: 99"),
                                   HasSubstr("inverted elements turned over: 2"),
                                   HasSubstr("duplicate elements left out: 3")));
    EXPECT_EQ(scene::parse_scene(scene::write_scene(scene), "again.yaml").bodies, scene.bodies);
}

TEST_F(MeshFilesOfScenes, ShortFormsStandForAPathAndForAllRepairs) {
    const scene::Scene all = scene_with("  b: {mesh: {file: {path: cubes.inp, repair: [all]}}, "
                                        "material: {linear_elastic: {E: 1 MPa, nu: 0.2}}}\n");
    const scene::Scene yes = scene_with("  b: {mesh: {file: {path: cubes.inp, repair: true}}, "
                                        "material: {linear_elastic: {E: 1 MPa, nu: 0.2}}}\n");
    EXPECT_EQ(all.bodies, yes.bodies);
    EXPECT_EQ(build_meshes(all)[0].element_count(), 2);
    const scene::Scene plain =
        scene_with("  b: {mesh: {file: cubes.inp}, material: {linear_elastic: {E: 1 MPa, nu: 0.2}}}\n");
    try {
        (void)build_meshes(plain);
        FAIL() << "its faults are not mended";
    } catch (const SceneError& error) {
        EXPECT_EQ(error.faults().size(), 4u);
        EXPECT_THAT(error.what(),
                    AllOf(HasSubstr("bodies.b.mesh"), HasSubstr("node 99 belongs to nothing"),
                          HasSubstr("element 2 is inverted"), HasSubstr("element 3 has the nodes of element 2")));
    }
}

TEST_F(MeshFilesOfScenes, ElementsFoldedBetweenTheirNodesAreFaultsOfTheScene) {
    // its Jacobian is positive at every node, and not at a quadrature point
    std::ofstream("folded.inp")
        << "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n5,.5,-.3,0\n6,.1,.5,0\n7,0,.8,0\n8,0,0,.5\n"
           "9,.5,0,.5\n10,0,.5,.5\n*ELEMENT, TYPE=C3D10\n8, 1,2,3,4,5,6,7,8,9,10\n";
    const scene::Scene scene = scene_with("  b: {mesh: {file: folded.inp, translate: [0, 0, 100]}, "
                                          "material: {linear_elastic: {E: 1 MPa, nu: 0.2}}}\n");
    Timings timings;
    try {
        (void)compile(scene, build_meshes(scene), 1, timings);
        FAIL() << "no kernel can compute it";
    } catch (const SceneError& error) {
        ASSERT_EQ(error.faults().size(), 1u);
        EXPECT_EQ(error.faults()[0].key, "bodies.b.mesh");
        EXPECT_THAT(
            error.what(),
            HasSubstr("tet10 element 0 of block 0: Jacobian is not positive at [0.00875388, 0.659574, 100.138] m"));
    }
}

TEST_F(MeshFilesOfScenes, GeometryIsMeshedAsTheSceneSays) {
    if (!OSCULATE_HAS_GMSH) GTEST_SKIP() << "built without Gmsh's library";
    std::filesystem::copy_file(support::source_tree() + "/tests/mesh/data/quarter_cylinder.brep", "part.brep");
    const scene::Scene scene = scene_with(
        "  b:\n    mesh: {cad: {path: part.brep, size: 0.3 m, smallest: 0.05 m, per_circle: 12, quadratic: true, "
        "focus: {point: [0, 0, 1 m], size: 0.1 m, extent: 0.2 m, growth: 1.5}, part: "
        "volume_1, piece: 1}, scale: 0.1}\n"
        "    material: {linear_elastic: {E: 1 MPa, nu: 0.2}}\n");
    const mesh::Mesh fine = build_meshes(scene)[0];
    EXPECT_EQ(fine.blocks.at(0).type, mesh::CellType::tet10);
    EXPECT_TRUE(fine.surfaces.contains("face_1"));
    double top = 0;
    for (const Vec3& x : fine.nodes) top = std::max(top, x.z());
    EXPECT_DOUBLE_EQ(top, 0.1);
    EXPECT_EQ(scene::parse_scene(scene::write_scene(scene), "again.yaml").bodies, scene.bodies);
    EXPECT_THROW((void)scene_with("  b: {mesh: {cad: {path: part.brep, size: 1 m, smallest: 2 m}}, "
                                  "material: {linear_elastic: {E: 1 MPa, nu: 0.2}}}\n"),
                 SceneError);
    const scene::Scene even =
        scene_with("  b: {mesh: {cad: {path: part.brep}}, material: {linear_elastic: {E: 1 MPa, nu: 0.2}}}\n");
    EXPECT_EQ(scene::parse_scene(scene::write_scene(even), "again.yaml").bodies, even.bodies);
    // small elements of no size, of a size that the others have, or of one that is forbidden
    for (const char* focus : {"focus: {point: [0, 0, 1 m]}", "focus: {point: [0, 0, 0]}",
                              "size: 0.3 m, focus: {size: 0.3 m}", "smallest: 0.2 m, focus: {size: 0.1 m}"})
        EXPECT_THROW((void)scene_with("  b: {mesh: {cad: {path: part.brep, " + std::string(focus) +
                                      "}}, material: {linear_elastic: {E: 1 MPa, nu: 0.2}}}\n"),
                     SceneError)
            << focus;
}

/// Mean length of the edges of facets whose nodes all have x . n = d.
double mean_edge(const mesh::Mesh& m, const Vec3& n, double d) {
    double sum = 0;
    int count = 0;
    for (const mesh::Facet& facet : mesh::exterior_facets(m)) {
        if (std::ranges::any_of(facet, [&](Index i) { return std::abs(m.nodes[i].dot(n) - d) > 1e-9; })) continue;
        for (int c = 0; c < facet.count; ++c, ++count)
            sum += (m.nodes[facet.nodes[c]] - m.nodes[facet.nodes[(c + 1) % facet.count]]).norm();
    }
    return sum / count;
}

TEST_F(MeshFilesOfScenes, GeometryIsMeshedMoreFinelyWhereItMeetsOthers) {
    if (!OSCULATE_HAS_GMSH) GTEST_SKIP() << "built without Gmsh's library";
    const std::string data = support::source_tree() + "/tests/mesh/data/",
                      whole = file_content(data + "foot_on_table.yaml");
    std::filesystem::copy_file(data + "quarter_cylinder.brep", "quarter_cylinder.brep");
    const auto scene = [&](std::vector<std::pair<std::string, std::string>> changes) {
        std::string text = whole;
        for (const auto& [from, to] : changes) text.replace(text.find(from), from.size(), to);
        return scene::parse_scene(text, "scene.yaml");
    };
    constexpr double size = 0.025;
    const mesh::Mesh m = build_meshes(scene({}))[0];
    EXPECT_NEAR(mean_edge(m, Vec3::UnitZ(), 0), size, 0.25 * size);
    EXPECT_GT(mean_edge(m, Vec3::UnitZ(), 1), 3 * size) << "away from contact";
    // as slave, as master, and placed elsewhere: the same mesh
    const std::string pair = "{between: [sole, top]}";
    EXPECT_EQ(build_meshes(scene({{pair, "{slave: sole, master: {set: top}}"}}))[0].nodes, m.nodes);
    EXPECT_EQ(build_meshes(scene({{pair, "{slave: top, master: {set: sole}}"}}))[0].nodes, m.nodes);
    const mesh::Mesh placed = build_meshes(
        scene({{"1.5}}}", "1.5}}, scale: 2, rotate: {axis: [0, 0, 1], angle: 90 deg}, translate: [1, 2, 0]}"}}))[0];
    ASSERT_EQ(placed.nodes.size(), m.nodes.size());
    for (std::size_t i = 0; i < m.nodes.size(); ++i) {
        const Vec3& X = m.nodes[i];
        EXPECT_LT((placed.nodes[i] - Vec3(1 - 2 * X.y(), 2 + 2 * X.x(), 2 * X.z())).norm(), 1e-6);
    }
    // a part of the same geometry that meets nothing is meshed with it
    const mesh::Mesh twin =
        build_meshes(scene({{"  table:\n", "  twin:\n    mesh: {cad: {path: quarter_cylinder.brep, size: 0.1 m, "
                                           "contact: {size: 0.025 m, growth: 1.5}}}\n"
                                           "    material: {linear_elastic: {E: 1 MPa, nu: 0.2}}\n  table:\n"}}))[1];
    EXPECT_EQ(twin.nodes, m.nodes);
    try {
        (void)build_meshes(scene({{"contact:\n  stands: " + pair + "\n", ""}}));
        FAIL() << "it meets nothing";
    } catch (const SceneError& error) {
        EXPECT_THAT(error.what(), AllOf(HasSubstr("bodies.foot.mesh.cad.contact.size"),
                                        HasSubstr("a contact pair with a set of the body")));
    }
    EXPECT_THROW((void)scene({{"0.025 m", "0.1 m"}}), SceneError) << "as large as all others";
    EXPECT_THROW((void)scene({{"size: 0.1 m,", "size: 0.1 m, smallest: 0.05 m,"}}), SceneError) << "forbidden";
}

} // namespace
} // namespace osculate::app::OSCULATE_THIS_FILE
