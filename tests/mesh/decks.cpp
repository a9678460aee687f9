#include "mesh/file_tests.hpp"
#include "osculate/mesh/deck_mesh.hpp"
#include "osculate/mesh/quality.hpp"

namespace osculate::mesh::OSCULATE_THIS_FILE {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

/// Two unit cubes, one on the other, and a third apart.
const std::string nodes_of_cubes = "*Node, nset=All\n"
                                   "1, 0, 0, 0\n2, 1, 0, 0\n3, 1, 1, 0\n4, 0, 1, 0\n"
                                   "5, 0, 0, 1\n6, 1, 0, 1\n7, 1, 1, 1\n8, 0, 1, 1\n"
                                   "** the upper\n"
                                   "9, 0., 0., 2.\n10, 1.D0, 0, 2.0\n11, +1, 1, 2\n12, 0, 1, 2\n"
                                   "101, 0, 0, 5\n102, 1, 0, 5\n103, 1, 1, 5\n104, 0, 1, 5\n"
                                   "105, 0, 0, 6\n106, 1, 0, 6\n107, 1, 1, 6\n108, 0, 1, 6\n";
const std::string cubes = nodes_of_cubes + "*ELEMENT, TYPE=C3D8, ELSET=low\n1, 1,2,3,4,5,6,7,8\n"
                                           "*element, type=c3d8i,\nelset=up\n2, 5,6,7,8,\n9,10,11,12\n"
                                           "*ELEMENT, TYPE=C3D8R, ELSET=apart\n3, 101,102,103,104,105,106,107,108\n";

class Decks : public fixtures::FileTest {};

TEST_F(Decks, ReadsElementsOverSeveralLinesAndNamesInAnyCase) {
    const DeckMesh deck = read_deck_mesh(parse_deck(cubes, "cubes"));
    EXPECT_THAT(deck.types, ElementsAre("C3D8", "C3D8I", "C3D8R"));
    const Mesh mesh = make_mesh(deck.raw);
    EXPECT_EQ(mesh.node_count(), 20);
    EXPECT_EQ(mesh.element_count(), 3);
    EXPECT_EQ(mesh.nodes[9], Vec3(1, 0, 2));
    EXPECT_THAT(faults(mesh), IsEmpty());
    EXPECT_EQ(mesh.node_sets.at("All").size(), 20u);
}

TEST_F(Decks, TakesAnElementSetOrAConnectedPieceAsABody) {
    const std::string path = write("cubes.inp", cubes);
    EXPECT_EQ(mesh_of(path, {"up", 0, {}}).nodes.front(), Vec3(0, 0, 1));
    EXPECT_EQ(mesh_of(path, {"", 1, {}}).element_count(), 2);
    EXPECT_EQ(mesh_of(path, {"", 2, {}}).nodes.front(), Vec3(0, 0, 5));
    EXPECT_THAT(error_of(path, {"", 3, {}}), HasSubstr("the number of pieces is 2"));
    EXPECT_THAT(error_of(path, {"UP", 0, {}}), AllOf(HasSubstr("no part is called 'UP'"), HasSubstr("apart, low, up")));
}

TEST_F(Decks, SetsHaveRangesAndOtherSets) {
    const Mesh mesh = make_mesh(read_deck_mesh(parse_deck(cubes + "*NSET, NSET=ground, GENERATE\n1, 4\n"
                                                                  "*NSET, NSET=even, GENERATE\n2, 12, 2\n"
                                                                  "*NSET, NSET=both\nGROUND, 12\n9,\n"
                                                                  "*NSET, NSET=both\n10\n",
                                                          "cubes"))
                                    .raw);
    EXPECT_THAT(mesh.node_sets.at("ground"), ElementsAre(0, 1, 2, 3));
    EXPECT_THAT(mesh.node_sets.at("even"), ElementsAre(1, 3, 5, 7, 9, 11));
    EXPECT_THAT(mesh.node_sets.at("both"), ElementsAre(0, 1, 2, 3, 8, 9, 11));
}

TEST_F(Decks, SurfacesAreFacesOfElementsTheirOutsideOrNodes) {
    const Mesh mesh = make_mesh(read_deck_mesh(parse_deck(cubes + "*SURFACE, NAME=top\nup, S2\n"
                                                                  "*SURFACE, NAME=between\n1, S2\n2, S1\n"
                                                                  "*SURFACE, NAME=skin\nlow,\n"
                                                                  "*SURFACE, NAME=points, TYPE=NODE\n9\nall,\n",
                                                          "cubes"))
                                    .raw);
    ASSERT_EQ(mesh.surfaces.at("top").size(), 1u);
    EXPECT_EQ(facet_normal(mesh.surfaces.at("top")[0], mesh.nodes), Vec3(0, 0, 1));
    EXPECT_FALSE(mesh.surfaces.contains("between")) << "no part of the outside";
    EXPECT_EQ(mesh.surfaces.at("skin").size(), 5u);
    EXPECT_EQ(mesh.node_sets.at("points").size(), 20u);
}

TEST_F(Decks, EveryFaceLabelIsTheFaceThatItNames) {
    // Outward normals of S1, S2, ... of a cell with right angles at its first node, as in the manuals' figures.
    struct Case {
        std::string type, nodes;
        std::vector<Vec3> normals;
    };
    const double d = 1 / std::sqrt(3.0), e = 1 / std::sqrt(2.0);
    const std::vector<Case> cases{
        {"C3D8", "1,2,3,4,5,6,7,8", {{0, 0, -1}, {0, 0, 1}, {0, -1, 0}, {1, 0, 0}, {0, 1, 0}, {-1, 0, 0}}},
        {"C3D6", "1,2,4,5,6,8", {{0, 0, -1}, {0, 0, 1}, {0, -1, 0}, {e, e, 0}, {-1, 0, 0}}},
        {"C3D4", "1,2,4,5", {{0, 0, -1}, {0, -1, 0}, {d, d, d}, {-1, 0, 0}}},
    };
    for (const Case& c : cases)
        for (std::size_t f = 0; f < c.normals.size(); ++f) {
            const std::string text = nodes_of_cubes + "*ELEMENT, TYPE=" + c.type + "\n1, " + c.nodes +
                                     "\n*SURFACE, NAME=face\n1, S" + std::to_string(f + 1) + "\n";
            MeshFileOptions options = repairing({Repair::dangling_nodes});
            const Mesh mesh = make_mesh(read_deck_mesh(parse_deck(text, "cell")).raw, options);
            ASSERT_EQ(mesh.surfaces.at("face").size(), 1u);
            EXPECT_NEAR((facet_normal(mesh.surfaces.at("face")[0], mesh.nodes) - c.normals[f]).norm(), 0, 1e-15)
                << c.type << " S" << f + 1;
        }
}

TEST_F(Decks, FacesOfTenNodeTetrahedraAreFourFacets) {
    const std::string text = "*NODE\n1,0,0,0\n2,1,0,0\n3,0,1,0\n4,0,0,1\n5,.5,0,0\n6,.5,.5,0\n7,0,.5,0\n8,0,0,.5\n"
                             "9,.5,0,.5\n10,0,.5,.5\n*ELEMENT, TYPE=C3D10, ELSET=all\n1, 1,2,3,4,5,6,7,8,9,10\n"
                             "*SURFACE, NAME=slant\nall, S3\n";
    const Mesh mesh = make_mesh(read_deck_mesh(parse_deck(text, "tet")).raw);
    ASSERT_EQ(mesh.surfaces.at("slant").size(), 4u);
    for (const Facet& facet : mesh.surfaces.at("slant"))
        for (const Index node : facet) EXPECT_EQ(mesh.nodes[node].sum(), 1);
}

TEST_F(Decks, IncludeFilesOfTheirFolder) {
    std::filesystem::create_directory(folder / "parts");
    (void)write("parts/nodes.inp", nodes_of_cubes);
    (void)write("parts/mesh.inp", "*INCLUDE, INPUT=nodes.inp\n*ELEMENT, TYPE=C3D8\n1, 1,2,3,4,5,6,7,8\n");
    const std::string path = write("deck.inp", "*HEADING\nwords\n*INCLUDE, INPUT=parts/mesh.inp\n");
    EXPECT_EQ(mesh_of(path, repairing({Repair::dangling_nodes})).node_count(), 8);
    const std::string missing = write("missing.inp", "**\n*INCLUDE, INPUT=none.inp\n");
    EXPECT_THAT(error_of(missing), AllOf(HasSubstr("missing.inp:2"), HasSubstr("none.inp: no such file")));
    const std::string itself = write("itself.inp", "*INCLUDE, INPUT=itself.inp\n");
    EXPECT_THAT(error_of(itself), HasSubstr("deeper than 10"));
}

TEST_F(Decks, SayWhatIsWrongAtWhichLineAllAtOnce) {
    const std::string path = write("bad.inp", "*NODE\n1, 0, 0, 0\n2, 1, zero, 0\n3, 0, 1, 0\n4, 0, 0, 1\n"
                                              "*ELEMENT, TYPE=CPE9\n1, 1, 2, 3\n"
                                              "*ELEMENT, TYPE=C3D4\n7, 1, 3, 4, 99\n8, 1, 3\n"
                                              "*NSET, NSET=none\nmissing\n*NSET\n1\n");
    EXPECT_THAT(error_of(path),
                AllOf(HasSubstr("bad.inp:3: a node is"), HasSubstr("bad.inp:6: *ELEMENT of type 'CPE9'; only C3D8,"),
                      HasSubstr("bad.inp:9: element 7 has node 99"), HasSubstr("bad.inp:10: an element of type C3D4"),
                      HasSubstr("bad.inp:12: no set is called 'missing'"), HasSubstr("bad.inp:13: *NSET without")));
    EXPECT_THAT(error_of(write("faces.inp", cubes + "*SURFACE, NAME=s\n1, S9\n7, S1\n")),
                AllOf(HasSubstr("element 1 has no face 'S9'"), HasSubstr("no element or element set '7'")));
    EXPECT_THAT(error_of(write("twice.inp", "*NODE\n1,0,0,0\n1,1,0,0\n")), HasSubstr("node 1 is defined twice"));
    EXPECT_THAT(error_of(write("data.inp", "\n1,0,0,0\n")), HasSubstr("data.inp:2: data before any keyword"));
}

} // namespace
} // namespace osculate::mesh::OSCULATE_THIS_FILE
