#include "scenes/program.hpp"

#include <gmock/gmock.h>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// Two cubes on top of each other, pressed.
const std::string deck = "*NODE\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
                         "11,0,0,1\n12,1,0,1\n13,1,1,1\n14,0,1,1\n15,0,0,2\n16,1,0,2\n17,1,1,2\n18,0,1,2\n"
                         "*ELEMENT, TYPE=C3D8, ELSET=cubes\n1,1,2,3,4,5,6,7,8\n2,11,12,13,14,15,16,17,18\n"
                         "*NSET, NSET=floor, GENERATE\n1,4\n*NSET, NSET=sides, GENERATE\n11,18\n"
                         "*SURFACE, NAME=low\n1,S2\n*SURFACE, NAME=up\n2,S1\n*SURFACE, NAME=lid\n2,S2\n"
                         "*MATERIAL, NAME=m\n*ELASTIC\n1000.,.25\n*SOLID SECTION, ELSET=cubes, MATERIAL=m\n"
                         "*CONTACT PAIR, INTERACTION=i, TYPE=NODE TO SURFACE\nup,low\n*SURFACE INTERACTION, NAME=i\n"
                         "*BOUNDARY\nfloor,1,3\nsides,1,2\n"
                         "*STEP\n*STATIC\n*DSLOAD\nlid,P,2.\n*NODE PRINT\nU\n*END STEP\n";

const std::string press = scene_file("tests/scenes/press.yaml");

class MeshCommand : public Program {
protected:
    void SetUp() override {
        Program::SetUp();
        std::ofstream(folder / "deck.inp") << deck;
    }
};

TEST_F(MeshCommand, ShowsWhatAFileHolds) {
    const Outcome outcome = osculate({"mesh", "deck.inp"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out,
                AllOf(HasSubstr("16 nodes, 2 elements: 2 hex8\nfrom [0, 0, 0] to [1, 1, 2]\n"
                                "part cubes: 2 elements\nsurface lid: 1 facets, area 1\n"),
                      HasSubstr("nodes floor: 4\n"), HasSubstr("4 nodes at the same place as another, not merged")));
    EXPECT_THAT(osculate({"mesh", "deck.inp", "--piece", "2"}).out, HasSubstr("8 nodes, 1 elements"));
    const Outcome merged = osculate({"mesh", "deck.inp", "--repair", "coincident_nodes"});
    EXPECT_THAT(merged.out, AllOf(HasSubstr("12 nodes, 2 elements"), HasSubstr("4 nodes merged")));
    const Outcome refused = osculate({"mesh", "deck.inp", "--part", "cube"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("no part is called 'cube'"));
}

TEST_F(MeshCommand, ImportedDecksPassTheCheckAndRun) {
    const Outcome imported = osculate({"import", "deck.inp"});
    EXPECT_EQ(imported.code, 0) << imported.err;
    EXPECT_EQ(imported.err, "deck.inp:45: *NODE PRINT: what is written is chosen under output\n");
    std::ofstream(folder / "imported.yaml") << imported.out;
    const Outcome checked = osculate({"check", "imported.yaml"});
    EXPECT_EQ(checked.code, 0) << checked.err;
    EXPECT_THAT(checked.out, HasSubstr("pair up_on_low: 4 slave nodes, 1 master facets"));
    ASSERT_EQ(osculate({"run", "imported.yaml", "-o", "run", "--quiet"}).code, 0);
    EXPECT_NEAR(Csv(folder / "run/history.csv").number(0, "pair.up_on_low.normal"), 2, 1e-9);
    const Outcome refused = osculate({"import", "none.inp"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("none.inp: no such file"));
}

TEST_F(MeshCommand, ImportsTakeDecksInMillimetres) {
    const Outcome imported = osculate({"import", "deck.inp", "--units", "mm"});
    EXPECT_EQ(imported.code, 0) << imported.err;
    EXPECT_THAT(imported.out, AllOf(HasSubstr("scale: 0.001"), HasSubstr("E: 1000000000"), HasSubstr("lid: 2000000")));
    EXPECT_EQ(osculate({"import", "deck.inp", "--units", "si"}).code, 0);
    EXPECT_EQ(osculate({"import", "deck.inp", "--units", "inch"}).code, 2);
}

TEST_F(MeshCommand, ImportsThatLosePhysicsWriteNothingUnlessAllowed) {
    std::ofstream(folder / "lossy.inp") << deck + "*STEP\n*STATIC\n*DSLOAD\nlip,P,2.\n*END STEP\n";
    const Outcome refused = osculate({"import", "lossy.inp"});
    EXPECT_EQ(refused.code, 5);
    EXPECT_EQ(refused.out, "");
    EXPECT_THAT(refused.err,
                AllOf(HasSubstr("--allow-loss"), HasSubstr("lossy.inp:51: lip,P,2.: no surface of that name\n")));
    const Outcome allowed = osculate({"import", "lossy.inp", "--allow-loss"});
    EXPECT_EQ(allowed.code, 0);
    EXPECT_THAT(allowed.out, HasSubstr("# Lost:\n#   lossy.inp:51: lip,P,2."));
}

TEST_F(MeshCommand, ImportedFacesThatAreLoadedTwiceRunWithBothLoads) {
    std::string twice = deck;
    twice.insert(twice.find("*NODE PRINT"), "*DSLOAD\nlid,P,1.\n");
    std::ofstream(folder / "twice.inp") << twice;
    std::ofstream(folder / "twice.yaml") << osculate({"import", "twice.inp"}).out;
    ASSERT_EQ(osculate({"run", "twice.yaml", "-o", "run", "--quiet"}).code, 0);
    EXPECT_NEAR(Csv(folder / "run/history.csv").number(0, "pair.up_on_low.normal"), 3, 1e-9);
}

const std::string bracket = scene_file("configs/tutorials/geometry/bracket.step");

/// Numbers, types and points of faces are what sets of a scene are made of; a picture shows where they are.
TEST_F(MeshCommand, ListsTheFacesOfAGeometryAndDrawsThem) {
    if (!OSCULATE_HAS_GMSH) GTEST_SKIP() << "built without Gmsh's library";
    const Outcome outcome = osculate({"mesh", bracket, "--picture", "faces.svg"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("1 solid, 14 faces, 33 edges; from [-0.03, -0.02, 0] to [0.03, 0.02, 0.0"),
                                   HasSubstr("volume_1  'bracket'"), HasSubstr("face_14"), HasSubstr("Cylinder"),
                                   HasSubstr("0.006")));
    const std::string picture = content(folder / "faces.svg");
    for (int face = 1; face <= 14; ++face) // from one side or the other
        EXPECT_THAT(picture, HasSubstr(">" + std::to_string(face) + "</text>"));
    std::ofstream(folder / "bracket.yaml") << content(scene_file("configs/tutorials/bracket.yaml"));
    std::filesystem::create_directory(folder / "geometry");
    std::filesystem::copy_file(bracket, folder / "geometry/bracket.step");
    const Outcome edge = osculate(
        {"check", "bracket.yaml", "--set", "sets.screw_1={body: bracket, nearest: {point: [-30 mm, 0 mm, 8 mm]}}"});
    EXPECT_EQ(edge.code, 2);
    EXPECT_THAT(edge.err, HasSubstr("sets.screw_1.nearest: expected a point away from edges of surfaces, found one as "
                                    "near to face_1 and face_3"));
    const Outcome block =
        osculate({"check", press, "--set", "sets.bed={body: base, nearest: {point: [0.7 m, 0.6 m, -1 m]}}"});
    EXPECT_EQ(block.code, 0) << block.err << "surfaces of generated meshes have names, too";
}

TEST_F(MeshCommand, DrawsNoMesh) {
    const Outcome outcome = osculate({"mesh", "deck.inp", "--picture", "faces.svg"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err, HasSubstr("--picture: expected a geometry"));
    EXPECT_EQ(osculate({"mesh", bracket, "--part", "volume_1"}).code, 2);
    const Outcome nowhere = osculate({"mesh", bracket, "--picture", "nowhere/faces.svg"});
    EXPECT_EQ(nowhere.code, 2);
    EXPECT_THAT(nowhere.err, HasSubstr(OSCULATE_HAS_GMSH ? "a file that can be written" : "libgmsh-dev"));
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
