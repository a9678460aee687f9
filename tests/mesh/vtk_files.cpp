#include "mesh/file_tests.hpp"
#include "osculate/mesh/quality.hpp"

#include <vtk_exodusII.h>

namespace osculate::mesh::OSCULATE_THIS_FILE {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// A cube and a tetrahedron on its top.
const std::string legacy = "# vtk DataFile Version 3.0\ncube\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 9 double\n"
                           "0 0 0 1 0 0 1 1 0 0 1 0 0 0 1 1 0 1 1 1 1 0 1 1 .5 .5 2\n"
                           "CELLS 3 20\n8 0 1 2 3 4 5 6 7\n4 4 5 6 8\n5 3 2 1 0 8\nCELL_TYPES 3\n12\n10\n7\n"
                           "CELL_DATA 3\nSCALARS mat_id int 1\nLOOKUP_TABLE default\n5\n7\n5\n"
                           "POINT_DATA 9\nSCALARS ground int 1\nLOOKUP_TABLE default\n1 1 1 1 0 0 0 0 0\n";

class VtkFiles : public fixtures::FileTest {};

TEST_F(VtkFiles, LegacyFilesHaveSetsAndParts) {
    const std::string path = write("cube.vtk", legacy);
    const Mesh mesh = mesh_of(path, repairing({Repair::non_manifold}));
    EXPECT_EQ(mesh.element_count(), 2);
    EXPECT_THAT(faults(mesh), IsEmpty());
    EXPECT_EQ(mesh.surfaces.at("ground").size(), 1u);
    EXPECT_EQ(mesh_of(path, {"mat_id=7", 0, {}}).node_count(), 4);
    EXPECT_EQ(mesh_of(path, {"mat_id=5", 0, {}}).node_count(), 8);
}

TEST_F(VtkFiles, LegacyFilesThatCannotBeReadSayWhy) {
    EXPECT_THAT(error_of(write("grid.vtk", "# vtk DataFile Version 3.0\nx\nASCII\nDATASET STRUCTURED_POINTS\n"
                                           "DIMENSIONS 2 2 2\nORIGIN 0 0 0\nSPACING 1 1 1\n")),
                HasSubstr("no UNSTRUCTURED_GRID"));
    EXPECT_NE(error_of(write("words.vtk", "no mesh at all\n")), "");
    EXPECT_NE(error_of(write("cut.vtk", legacy.substr(0, 150))), "");
    EXPECT_THAT(error_of(write("part.stl", "solid\n")), AllOf(HasSubstr("'.stl'"), HasSubstr(".msh")));
}

/// Two cubes side by side along x in blocks `left` and one without a name, 2 node sets, a side set on the right.
void write_exodus(const std::string& path) {
    int real = sizeof(double), io = sizeof(double);
    const int file = ex_create(path.c_str(), EX_CLOBBER, &real, &io);
    ASSERT_GE(file, 0);
    ex_put_init(file, "two cubes", 3, 12, 2, 2, 2, 1);
    std::vector<double> x, y, z;
    for (int layer = 0; layer < 3; ++layer)
        for (int corner = 0; corner < 4; ++corner) {
            x.push_back(layer);
            y.push_back(corner == 1 || corner == 2);
            z.push_back(corner >= 2);
        }
    ex_put_coord(file, x.data(), y.data(), z.data());
    for (int b = 0; b < 2; ++b) {
        ex_put_block(file, EX_ELEM_BLOCK, 10 + b, "HEX8", 1, 8, 0, 0, 0);
        int nodes[8];
        for (int i = 0; i < 8; ++i) nodes[i] = 4 * b + i + 1;
        ex_put_conn(file, EX_ELEM_BLOCK, 10 + b, nodes, nullptr, nullptr);
    }
    ex_put_name(file, EX_ELEM_BLOCK, 10, "left");
    const int seam[] = {5, 6, 7, 8}, pin[] = {1};
    ex_put_set_param(file, EX_NODE_SET, 3, 4, 0);
    ex_put_set(file, EX_NODE_SET, 3, seam, nullptr);
    ex_put_set_param(file, EX_NODE_SET, 4, 1, 0);
    ex_put_set(file, EX_NODE_SET, 4, pin, nullptr);
    ex_put_name(file, EX_NODE_SET, 4, "pin");
    const int element[] = {2}, side[] = {6}; // of a HEX8: the face of its last four nodes
    ex_put_set_param(file, EX_SIDE_SET, 5, 1, 0);
    ex_put_set(file, EX_SIDE_SET, 5, element, side);
    ex_put_name(file, EX_SIDE_SET, 5, "right");
    ex_close(file);
}

TEST_F(VtkFiles, ExodusHasBlocksNodeSetsAndSideSets) {
    const std::string path = (folder / "cubes.exo").string();
    write_exodus(path);
    const Mesh mesh = mesh_of(path);
    EXPECT_EQ(mesh.node_count(), 12);
    EXPECT_EQ(mesh.element_count(), 2);
    EXPECT_THAT(faults(mesh), IsEmpty());
    EXPECT_THAT(mesh.node_sets.at("node_set_3"), ElementsAre(4, 5, 6, 7));
    EXPECT_THAT(mesh.node_sets.at("pin"), ElementsAre(0));
    ASSERT_EQ(mesh.surfaces.at("right").size(), 1u);
    EXPECT_EQ(facet_normal(mesh.surfaces.at("right")[0], mesh.nodes), Vec3(1, 0, 0));
    const Mesh left = mesh_of(path, {"left", 0, {}});
    EXPECT_EQ(left.node_count(), 8);
    EXPECT_FALSE(left.surfaces.contains("right"));
    EXPECT_EQ(mesh_of(path, {"block_11", 0, {}}).nodes.front(), Vec3(1, 0, 0));
    EXPECT_THAT(error_of(write("words.exo", "no mesh at all\n")), HasSubstr("not an Exodus II file"));
    std::filesystem::resize_file(path, 100);
    EXPECT_NE(error_of(path), "");
}

} // namespace
} // namespace osculate::mesh::OSCULATE_THIS_FILE
