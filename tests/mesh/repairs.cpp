#include "mesh/file_tests.hpp"
#include "osculate/mesh/deck_mesh.hpp"
#include "osculate/mesh/quality.hpp"

namespace osculate::mesh::OSCULATE_THIS_FILE {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

class MeshRepairs : public fixtures::FileTest {
protected:
    static RawMesh raw(const std::string& text) { return read_deck_mesh(parse_deck(text, "deck")).raw; }

    static std::string reasons(const RawMesh& raw, const MeshFileOptions& options = {}) {
        try {
            (void)make_mesh(raw, options);
        } catch (const MeshError& error) {
            return error.what();
        }
        return "";
    }
    static std::string notes(const RawMesh& raw, const MeshFileOptions& options = {}) {
        std::vector<std::string> list;
        (void)make_mesh(raw, options, &list);
        std::string text;
        for (const std::string& note : list) text += note + "\n";
        return text;
    }
    /// Unit cubes side by side along x, at 10 n + corner.
    static std::string cubes(int count) {
        std::string text = "*NODE\n";
        for (int layer = 0; layer <= count; ++layer)
            for (int corner = 0; corner < 4; ++corner)
                text += std::to_string(10 * layer + corner + 1) + "," + std::to_string(layer) + "," +
                        std::to_string(corner == 1 || corner == 2) + "," + std::to_string(corner >= 2) + "\n";
        return text;
    }
    static std::string hex(int id, int at) {
        std::string text = std::to_string(id);
        for (const int corner : {1, 2, 3, 4, 11, 12, 13, 14}) text += "," + std::to_string(10 * at + corner);
        return text + "\n";
    }
};

TEST_F(MeshRepairs, InvertedCellsAreNamedAndTurnedOver) {
    const RawMesh hexes = raw(cubes(2) + "*ELEMENT, TYPE=C3D8\n" + hex(7, 0) + "9, 21,22,23,24,11,12,13,14\n");
    EXPECT_THAT(reasons(hexes), AllOf(HasSubstr("element 9 is inverted"), HasSubstr("repair: [inverted]"),
                                      Not(HasSubstr("element 7"))));
    EXPECT_THAT(notes(hexes, repairing({Repair::inverted})), HasSubstr("1 inverted elements turned over: 9"));
    EXPECT_THAT(faults(make_mesh(hexes, repairing({Repair::inverted}))), IsEmpty());
    const std::string ten = "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n5,.5,0,0\n6,.5,.5,0\n7,0,.5,0\n8,0,0,.5\n"
                            "9,.5,0,.5\n10,0,.5,.5\n*ELEMENT, TYPE=C3D10\n";
    const RawMesh tet = raw(ten + "1, 2,1,3,4,5,7,6,9,8,10\n");
    EXPECT_THAT(reasons(tet), HasSubstr("element 1 is inverted"));
    EXPECT_THAT(faults(make_mesh(tet, repairing({Repair::inverted}))), IsEmpty());
    // middle nodes swapped: no turning over helps
    const RawMesh tangled = raw(ten + "1, 1,2,3,4,6,5,7,8,9,10\n");
    EXPECT_THAT(reasons(tangled, repairing({Repair::inverted})), HasSubstr("element 1 is tangled"));
}

TEST_F(MeshRepairs, QuadraticCellsWithACornerTwiceAreNamed) {
    const RawMesh two =
        raw("*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n5,.5,0,0\n6,.5,.5,0\n7,0,.5,0\n8,0,0,.5\n9,.5,0,.5\n"
            "*ELEMENT, TYPE=C3D10\n1, 1,2,1,3,5,6,7,8,9,4\n2, 1,2,1,4,5,6,7,8,9,3\n");
    EXPECT_THAT(reasons(two), AllOf(HasSubstr("element 1 is"), HasSubstr("element 2 is")));
}

TEST_F(MeshRepairs, DegenerateCellsBecomeWedgesOrGo) {
    const RawMesh wedge = raw(cubes(1) + "*ELEMENT, TYPE=C3D8\n1, 1,2,3,3,11,12,13,13\n");
    EXPECT_THAT(reasons(wedge), HasSubstr("element 1 is degenerate: it has a node twice"));
    const Mesh mended = make_mesh(wedge, repairing({Repair::degenerate, Repair::dangling_nodes}));
    ASSERT_EQ(mended.blocks.size(), 1u);
    EXPECT_EQ(mended.blocks[0].type, CellType::wedge6);
    EXPECT_THAT(faults(mended), IsEmpty());
    EXPECT_DOUBLE_EQ(cell_volume(CellType::wedge6, mended.blocks[0].connectivity, mended.nodes), 0.5);
    const RawMesh flat = raw(cubes(2) + "*ELEMENT, TYPE=C3D8\n" + hex(1, 0) + hex(2, 1) + "3, 1,2,3,4,1,2,3,4\n");
    EXPECT_THAT(reasons(flat), HasSubstr("element 3 is flat"));
    EXPECT_EQ(make_mesh(flat, repairing({Repair::degenerate})).element_count(), 2);
}

TEST_F(MeshRepairs, DuplicatesAndDanglingNodesGo) {
    const RawMesh mesh = raw(cubes(2) + "*ELEMENT, TYPE=C3D8\n" + hex(1, 0) + "5, 2,3,4,1,12,13,14,11\n");
    EXPECT_THAT(reasons(mesh), AllOf(HasSubstr("element 5 has the nodes of element 1"),
                                     HasSubstr("node 21 belongs to nothing"), HasSubstr("repair: [dangling_nodes]")));
    const Mesh mended = make_mesh(mesh, repairing({Repair::duplicate, Repair::dangling_nodes}));
    EXPECT_EQ(mended.element_count(), 1);
    EXPECT_EQ(mended.node_count(), 8);
}

TEST_F(MeshRepairs, CoincidentNodesAreToldAndMergedOnRequestOnly) {
    const RawMesh mesh = raw(cubes(1) +
                             "51,1,0,0\n52,1,1,0\n53,1,1,1\n54,1,0,1\n61,2,0,0\n62,2,1,0\n63,2,1,1\n64,2,0,1\n"
                             "*ELEMENT, TYPE=C3D8\n" +
                             hex(1, 0) + hex(2, 5) + "*NSET, NSET=seam\n51,52\n*SURFACE, NAME=end\n2, S2\n");
    EXPECT_THAT(notes(mesh), AllOf(HasSubstr("4 nodes at the same place as another"), HasSubstr("51 at 11")));
    EXPECT_EQ(make_mesh(mesh).node_count(), 16);
    const Mesh merged = make_mesh(mesh, repairing({Repair::coincident_nodes}));
    EXPECT_EQ(merged.node_count(), 12);
    EXPECT_EQ(exterior_facets(merged).size(), 10u);
    EXPECT_THAT(merged.node_sets.at("seam"), ElementsAre(4, 5));
    EXPECT_EQ(merged.surfaces.at("end").size(), 1u);
}

/// Two cubes that have the edge from (1, 1, 0) to (1, 1, 1) alone in common.
const std::string on_edge = "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
                            "9,2,1,0\n10,2,2,0\n11,1,2,0\n12,2,1,1\n13,2,2,1\n14,1,2,1\n"
                            "*ELEMENT, TYPE=C3D8\n1, 1,2,3,4,5,6,7,8\n2, 3,9,10,11,7,12,13,14\n"
                            "*NSET, NSET=edge\n3,7\n*SURFACE, NAME=top\n1, S2\n2, S2\n";

TEST_F(MeshRepairs, BodiesThatTouchAtAnEdgeOrANodeArePulledApart) {
    EXPECT_THAT(reasons(raw(on_edge)),
                HasSubstr("more than two exterior facets meet at the edge between node 3 and node 7"));
    const Mesh apart = make_mesh(raw(on_edge), repairing({Repair::non_manifold}));
    EXPECT_EQ(apart.node_count(), 16);
    EXPECT_EQ(apart.node_sets.at("edge").size(), 4u);
    EXPECT_EQ(apart.surfaces.at("top").size(), 2u);
    const RawMesh at_node = raw("*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n5,-1,0,0\n6,0,-1,0\n7,0,0,-1\n"
                                "*ELEMENT, TYPE=C3D4\n1, 1,2,3,4\n2, 1,6,5,7\n");
    EXPECT_THAT(reasons(at_node), HasSubstr("the surface touches itself at node 1"));
    EXPECT_EQ(make_mesh(at_node, repairing({Repair::non_manifold})).node_count(), 8);
}

TEST_F(MeshRepairs, BodiesThatTouchAtAnEdgeStayJoinedWhereThatIsWanted) {
    std::vector<std::string> notes;
    MeshFileOptions keep = repairing({Repair::keep_non_manifold});
    const Mesh joined = make_mesh(raw(on_edge), keep, &notes);
    EXPECT_EQ(joined.node_count(), 14);
    EXPECT_THAT(notes, ElementsAre(HasSubstr("2 nodes at which alone parts of the body are joined: 3, 7")));
    EXPECT_EQ(make_mesh(raw(on_edge), repairing({Repair::keep_non_manifold, Repair::non_manifold})).node_count(), 16);
}

/// A straight ten-node tetrahedron on the triangle of nodes 1, 2, 3 and the nodes of another below it, which may share
/// the nodes 5, 6, 7 in the middle of the triangle's edges or have 15, 16, 17 at their places, 17 moved by a length.
std::string two_tetrahedra(const std::string& below, double moved = 0) {
    return "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n5,.5,0,0\n6,.5,.5,0\n7,0,.5,0\n8,0,0,.5\n9,.5,0,.5\n"
           "10,0,.5,.5\n11,0,0,-1\n12,0,0,-.5\n13,.5,0,-.5\n14,0,.5,-.5\n15,.5,0,0\n16,.5,.5,0\n17," +
           std::to_string(moved) + ",.5,0\n*ELEMENT, TYPE=C3D10\n40, 1,2,3,4,5,6,7,8,9,10\n" + below;
}

TEST_F(MeshRepairs, FacesWithMidsideNodesInOneElementAloneAreNamed) {
    const MeshFileOptions mended = repairing({Repair::dangling_nodes, Repair::non_manifold});
    EXPECT_THAT(
        reasons(raw(two_tetrahedra("*ELEMENT, TYPE=C3D4\n50, 1,3,2,11\n")), mended),
        AllOf(HasSubstr("deck: element 40 and element 50 share a face, which has midside nodes in element 40 "
                        "alone (mesh the body with elements of one kind, all with midside nodes or all without)"),
              Not(HasSubstr("surface"))));
    EXPECT_THAT(reasons(raw("*NODE\n21,5,5,5\n" + two_tetrahedra("*ELEMENT, TYPE=C3D4\n30, 1,3,2,11\n")), mended),
                HasSubstr("share a face, which has midside nodes in element 40 alone"));
    // an edge between them is no face
    EXPECT_THAT(reasons(raw(two_tetrahedra("51, 1,3,2,11,7,6,5,12,14,13\n")), mended), IsEmpty());
}

TEST_F(MeshRepairs, FacesWithOtherMidsideNodesInEachElementAreNamed) {
    const std::string below = "50, 1,3,2,11,17,16,15,12,14,13\n";
    const char* const what = "deck: element 40 and element 50 share a face, but not its midside nodes (repair: "
                             "[coincident_nodes] mends this where they are at the same place)";
    EXPECT_THAT(reasons(raw(two_tetrahedra(below))), HasSubstr(what));
    const Mesh merged = make_mesh(raw(two_tetrahedra(below)), repairing({Repair::coincident_nodes}));
    EXPECT_EQ(merged.node_count(), 14);
    EXPECT_EQ(exterior_facets(merged).size(), 6u * 4);
    EXPECT_THAT(reasons(raw(two_tetrahedra(below, 0.01)), repairing({Repair::coincident_nodes})), HasSubstr(what));
}

TEST_F(MeshRepairs, CellsThatOverlapCannotBeMended) {
    const RawMesh three = raw(cubes(1) +
                              "21,2,0,0\n22,2,1,0\n23,2,1,1\n24,2,0,1\n31,3,0,0\n32,3,1,0\n33,3,1,1\n34,3,0,1\n"
                              "*ELEMENT, TYPE=C3D8\n" +
                              hex(1, 0) + hex(2, 1) + "3, 11,12,13,14,31,32,33,34\n");
    EXPECT_THAT(reasons(three, repairing({Repair::non_manifold})), HasSubstr("overlap"));
}

TEST_F(MeshRepairs, ManyFaultsAreCounted) {
    std::string text = cubes(40) + "*ELEMENT, TYPE=C3D8\n" + hex(1, 0);
    const std::string message = reasons(raw(text));
    EXPECT_THAT(message, HasSubstr("and 136 more dangling nodes"));
    EXPECT_EQ(std::count(message.begin(), message.end(), '\n'), 20);
}

} // namespace
} // namespace osculate::mesh::OSCULATE_THIS_FILE
