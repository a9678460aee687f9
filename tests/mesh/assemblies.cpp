#include "mesh/file_tests.hpp"
#include "osculate/mesh/deck_mesh.hpp"

#include <algorithm>

namespace osculate::mesh::OSCULATE_THIS_FILE {
namespace {

using ::testing::AllOf;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// Lines as Abaqus/CAE writes them, of a cube of size 1 at (1, 2, 3).
const std::string part = "*Heading\n** Job name: cube\n*Preprint, echo=NO\n**\n** PARTS\n**\n"
                         "*Part, name=Cube\n*Node\n"
                         "      1,           1.,           2.,           3.\n"
                         "      2, 2., 2., 3.\n3, 2., 3., 3.\n4, 1., 3., 3.\n"
                         "5, 1., 2., 4.\n6, 2., 2., 4.\n7, 2., 3., 4.\n8, 1., 3., 4.\n"
                         "*Element, type=C3D8R\n1, 1, 2, 3, 4, 5, 6, 7, 8\n"
                         "*Nset, nset=_PickedSet2, internal, generate\n 1,  8,  1\n"
                         "*Elset, elset=_PickedSet2, internal\n 1,\n"
                         "*Nset, nset=\"Lower side\"\n 1, 2, 3, 4\n"
                         "*Surface, type=ELEMENT, name=Top\n_PickedSet2, S2\n"
                         "** Section: Section-1\n*Solid Section, elset=_PickedSet2, material=Steel\n,\n*End Part\n**\n";

std::string assembly(const std::string& instances, const std::string& rest = "") {
    return part + "**\n** ASSEMBLY\n**\n*Assembly, name=Assembly\n**\n" + instances + rest + "*End Assembly\n";
}
/// The second is moved by (10, 0, 0), then turned by 90 degrees about the line through (10, 0, 0) along z.
const std::string two = "*Instance, name=Cube-1, part=Cube\n*End Instance\n**\n"
                        "*Instance, name=Cube-2, part=CUBE\n         10.,           0.,           0.\n"
                        "         10., 0., 0., 10., 0., 1., 90.\n*End Instance\n**\n";

DeckMesh read(const std::string& text) {
    return read_deck_mesh(parse_deck(text, "deck.inp"));
}

Vec3 node(const DeckMesh& mesh, const std::string& instance, long long number) {
    for (std::size_t p = 0; p < mesh.raw.points.size(); ++p) {
        const Instance* one = mesh.raw.instances.of(mesh.raw.point_ids[p]);
        if (one != nullptr && one->name == instance && mesh.raw.point_ids[p] - one->before == number)
            return mesh.raw.points[p];
    }
    ADD_FAILURE() << "no node " << number << " of " << instance;
    return Vec3::Zero();
}

class Assemblies : public fixtures::FileTest {
protected:
    std::string error(const std::string& text) { return error_of(write("deck.inp", text)); }
};

constexpr double round_off = 1e-14; // of cosines, times ten

TEST_F(Assemblies, InstancesAreMovedThenTurned) {
    const DeckMesh mesh = read(assembly(two));
    ASSERT_EQ(mesh.raw.points.size(), 16u);
    ASSERT_EQ(mesh.raw.cells.size(), 2u);
    EXPECT_EQ(node(mesh, "Cube-1", 1), Vec3(1, 2, 3)) << "to the last digit, as nothing moves it";
    // (1, 2, 3) is at (11, 2, 3) before it is turned: (1, 2) from the axis becomes (-2, 1)
    EXPECT_NEAR((node(mesh, "Cube-2", 1) - Vec3(8, 1, 3)).norm(), 0, round_off);
    EXPECT_NEAR((node(mesh, "Cube-2", 7) - Vec3(7, 2, 4)).norm(), 0, round_off);
}

TEST_F(Assemblies, TurnsAboutAnyAxis) {
    // a third of a turn about the diagonal through (1, 0, 0): x to y to z, from that point on
    const DeckMesh mesh = read(assembly("*Instance, name=A, part=Cube\n0., 0., 1.\n1., 0., 0., 2., 1., 1., 120.\n"
                                        "*End Instance\n"));
    EXPECT_NEAR((node(mesh, "A", 2) - Vec3(5, 1, 2)).norm(), 0, round_off) << "(2, 2, 3) moved: (2, 2, 4), then turned";
}

TEST_F(Assemblies, SetsAndSurfacesAreThoseOfEveryInstance) {
    const Mesh mesh = make_mesh(read(assembly(two)).raw);
    EXPECT_EQ(mesh.node_sets.at("Cube-1.Lower side").size(), 4u);
    EXPECT_EQ(mesh.node_sets.at("Cube-2.Lower side").size(), 4u);
    EXPECT_FALSE(mesh.node_sets.contains("Lower side"));
    ASSERT_EQ(mesh.surfaces.at("Cube-2.Top").size(), 1u);
    for (const Index n : mesh.surfaces.at("Cube-2.Top")[0]) EXPECT_EQ(mesh.nodes[n][2], 4);
    for (const Index n : mesh.node_sets.at("Cube-2.Lower side")) EXPECT_LT(mesh.nodes[n][0], 8.5);
}

TEST_F(Assemblies, AnInstanceIsAPartOfTheMesh) {
    const std::string path = write("deck.inp", assembly(two));
    EXPECT_EQ(mesh_of(path, {"Cube-2", 0, {}}).element_count(), 1);
    EXPECT_NEAR((mesh_of(path, {"Cube-2", 0, {}}).nodes.front() - Vec3(8, 1, 3)).norm(), 0, round_off);
    // but not where the assembly has another set of that name
    const std::string other = write("other.inp", assembly(two, "*Elset, elset=Cube-2, instance=Cube-1\n1\n"));
    EXPECT_EQ(mesh_of(other, {"Cube-2", 0, {}}).nodes.front(), Vec3(1, 2, 3));
}

TEST_F(Assemblies, SetsOfTheAssemblyReferToItsInstances) {
    const Mesh mesh =
        make_mesh(read(assembly(two, "*Nset, nset=Both, internal, instance=Cube-1\n 1, 2\n"
                                     "*Nset, nset=Both, internal, instance=\"cube-2\"\n 1, \"lower side\"\n"
                                     "*Nset, nset=Range, instance=Cube-2, generate\n 5, 99, 1\n"
                                     "*Nset, nset=Single\nCube-1.8, Assembly.Cube-2.8\n"
                                     "*Nset, nset=Nested\nBoth, \"Cube-1\".\"Lower side\"\n"
                                     "*Elset, elset=_Up_S2, internal, instance=Cube-2\n 1,\n"
                                     "*Surface, type=ELEMENT, name=Up\n_Up_S2, S2\nCube-1._PickedSet2, S2\n"
                                     "*Surface, type=ELEMENT, name=Down\nCUBE-1.1, S1\n"
                                     "*Surface, type=NODE, name=Points, internal\nCube-2.Lower side, 1.\n"))
                      .raw);
    EXPECT_EQ(mesh.node_sets.at("Both").size(), 6u);
    EXPECT_EQ(mesh.node_sets.at("Range").size(), 4u) << "those that there are";
    ASSERT_EQ(mesh.node_sets.at("Single").size(), 2u);
    EXPECT_EQ(mesh.nodes[mesh.node_sets.at("Single")[0]], Vec3(1, 3, 4));
    EXPECT_NEAR((mesh.nodes[mesh.node_sets.at("Single")[1]] - Vec3(7, 1, 4)).norm(), 0, round_off);
    EXPECT_EQ(mesh.node_sets.at("Nested").size(), 8u);
    EXPECT_EQ(mesh.surfaces.at("Up").size(), 2u);
    EXPECT_EQ(facet_normal(mesh.surfaces.at("Down")[0], mesh.nodes), Vec3(0, 0, -1));
    EXPECT_EQ(mesh.node_sets.at("Points").size(), 4u);
}

TEST_F(Assemblies, AnInstanceMayHaveItsOwnMesh) {
    std::string own = part;
    own.erase(own.find("*End Part"));
    const std::string mesh_lines = own.substr(own.find("*Node"));
    const std::string text = "*Part, name=Cube\n*End Part\n*Assembly, name=Assembly\n"
                             "*Instance, name=Cube-1, part=Cube\n0., 0., 7.\n" +
                             mesh_lines + "*End Instance\n*Nset, nset=One, instance=Cube-1\n5\n*End Assembly\n";
    const DeckMesh mesh = read(text);
    EXPECT_EQ(node(mesh, "Cube-1", 5), Vec3(1, 2, 11));
    EXPECT_EQ(mesh.raw.node_sets.at("One").size(), 1u);
    EXPECT_EQ(mesh.raw.surfaces.at("Cube-1.Top").size(), 1u);
}

TEST_F(Assemblies, NodesOfTheAssemblyKeepTheirNumbers) {
    const DeckMesh mesh = read(assembly(two, "*Node\n1, -1., -2., -3.\n*Nset, nset=Reference\n1\n"));
    ASSERT_EQ(mesh.raw.node_sets.at("Reference").size(), 1u);
    EXPECT_EQ(mesh.raw.points[static_cast<std::size_t>(mesh.raw.node_sets.at("Reference")[0])], Vec3(-1, -2, -3));
    EXPECT_EQ(mesh.raw.points[static_cast<std::size_t>(mesh.point(1))], Vec3(-1, -2, -3));
    EXPECT_EQ(mesh.raw.points[static_cast<std::size_t>(mesh.point(11))], Vec3(1, 2, 3)) << "node 1 of the first";
    EXPECT_EQ(mesh.raw.instances.shown(21), "1 of instance 'Cube-2'");
    EXPECT_EQ(mesh.raw.instances.shown(1), "1");
}

TEST_F(Assemblies, NumbersThatAreTooLargeToReadAreCloseTogether) {
    std::string far = part;
    for (std::size_t at = 0; (at = far.find("\n8, 1., 3., 4.", at)) != std::string::npos;)
        far.insert(at + 1, "19999999");
    far.replace(far.find("7, 8\n"), 5, "7, 199999998\n");
    const std::string assembly_of_far = far + "*Assembly, name=A\n" + two + "*End Assembly\n";
    const DeckMesh mesh = read(assembly_of_far);
    EXPECT_NEAR((node(mesh, "Cube-2", 199999998) - Vec3(7, 1, 4)).norm(), 0, round_off);
    EXPECT_EQ(make_mesh(mesh.raw).node_count(), 16);
}

TEST_F(Assemblies, NodesOfElementSetsAreThoseOfTheirInstance) {
    const DeckMesh mesh = read(assembly(two, "*Nset, nset=All of two, elset=Cube-2._PickedSet2\n"));
    EXPECT_THAT(mesh.raw.node_sets.at("All of two"), ElementsAre(8, 9, 10, 11, 12, 13, 14, 15));
}

TEST_F(Assemblies, FaultsHaveTheNumbersAndLinesOfTheDeck) {
    std::string bad = assembly(two);
    bad.replace(bad.find("1, 1, 2, 3, 4, 5"), 16, "1, 1, 2, 9, 4, 5");
    EXPECT_THAT(error(bad),
                AllOf(HasSubstr("deck.inp:18: element 1 of instance 'Cube-2' has node 9, which does not exist"),
                      Not(HasSubstr("29"))));
    std::string set = assembly(two);
    set.replace(set.find("\n 1, 2, 3, 4\n"), 13, "\n 1, 2, 3, 400\n");
    EXPECT_THAT(error(set), HasSubstr("deck.inp:24: instance 'Cube-1' has no node or element 400"));
    std::string inverted = assembly(two);
    inverted.replace(inverted.find("1, 1, 2, 3, 4, 5, 6, 7, 8"), 25, "1, 5, 6, 7, 8, 1, 2, 3, 4");
    EXPECT_THAT(error(inverted), HasSubstr("element 1 of instance 'Cube-2' is inverted"));
}

TEST_F(Assemblies, PlaneElementsStayInTheirPlane) {
    const auto plane = [](const std::string& axis) {
        return "*Part, name=P\n*Node\n1, 0., 0.\n2, 1., 0.\n3, 1., 1.\n4, 0., 1.\n*Element, type=CPE4\n1, 1,2,3,4\n"
               "*End Part\n*Assembly\n*Instance, name=P-1, part=P\n0., 0.\n0., 0., 0., " +
               axis + ", 30.\n*End Instance\n*End Assembly\n";
    };
    EXPECT_EQ(read(plane("0., 0., 1.")).raw.cells.size(), 1u);
    EXPECT_THAT(error(plane("1., 0., 0.")), HasSubstr("plane element 1 of instance 'P-1' is turned out of the plane"));
}

TEST_F(Assemblies, TeachWhatIsWrong) {
    const std::string instance = "*Instance, name=Cube-1, part=Cube\n*End Instance\n";
    const auto placed = [](const std::string& lines) {
        return assembly("*Instance, name=Cube-1, part=Cube\n" + lines + "*End Instance\n");
    };
    EXPECT_THAT(error(assembly("*Instance, name=B, part=Ball\n*End Instance\n")),
                AllOf(HasSubstr("deck.inp:37: *INSTANCE 'B' of part 'Ball', but no *PART before it is called so"),
                      HasSubstr("there are: Cube")));
    EXPECT_THAT(error(assembly(instance, "*Nset, nset=s, instance=Cube-7\n1\n")),
                HasSubstr("deck.inp:39: no *INSTANCE is called 'Cube-7'; there are: Cube-1"));
    EXPECT_THAT(error(assembly(instance, "*Nset, nset=s\nCube-7.Lower side\n")),
                HasSubstr("deck.inp:40: 'Cube-7.Lower side': no *INSTANCE is called 'Cube-7'; there are: Cube-1"));
    EXPECT_THAT(error(assembly(instance) + "*Boundary\nCube-7.5, 1, 3\n"),
                HasSubstr("no *INSTANCE is called 'Cube-7'"));
    EXPECT_THAT(error(assembly(instance, "*Nset, nset=s\nCube-1.99\n")),
                HasSubstr("deck.inp:40: instance 'Cube-1' has no node or element 99"));
    EXPECT_THAT(error(assembly(instance, "*Nset, nset=s\n3\n")), HasSubstr("deck.inp:40: node 3 does not exist"));
    EXPECT_THAT(error(assembly(instance + instance)), HasSubstr("deck.inp:39: a second *INSTANCE is called 'Cube-1'"));
    EXPECT_THAT(error(part + part), HasSubstr("a second *PART is called 'Cube'"));
    EXPECT_THAT(error(placed("1., 2., 3.\n0., 0., 0., 0., 0., 1.\n")),
                AllOf(HasSubstr("deck.inp:39: the second line of an *INSTANCE is its rotation, seven numbers"),
                      HasSubstr("found '0., 0., 0., 0., 0., 1.'")));
    EXPECT_THAT(error(placed("0., 0., 0., 0., 0., 1., 90.\n")),
                HasSubstr("the first line of an *INSTANCE is its translation"));
    EXPECT_THAT(error(placed("0., 0., 0.\n1., 1., 1., 1., 1., 1., 90.\n")), HasSubstr("the two points on the axis"));
    EXPECT_THAT(error(placed("0., 0., 0.\n0., 0., 0., 0., 0., 1., 90.\n1.\n")), HasSubstr("at most two data lines"));
    // ends that are missing
    std::string open = assembly(instance);
    open.erase(open.find("*End Part\n"), 10);
    EXPECT_THAT(error(open), HasSubstr("deck.inp:34: an *ASSEMBLY inside the *PART 'Cube' of"));
    EXPECT_THAT(error(part.substr(0, part.find("*End Part")) + part),
                AllOf(HasSubstr("a *PART inside the *PART 'Cube'"), HasSubstr("side by side")));
    EXPECT_THAT(error(part.substr(0, part.find("*End Part")) + "*Step\n*Static\n"),
                HasSubstr("*STEP belongs to the model, but stands in the *PART 'Cube' of "));
    EXPECT_THAT(error(part.substr(0, part.find("*End Part"))), HasSubstr("deck.inp:7: *PART that no *END PART ends"));
    EXPECT_THAT(error(part), HasSubstr("deck.inp:7: parts, but no *ASSEMBLY with an *INSTANCE"));
    EXPECT_THAT(error(part + instance), HasSubstr("an *INSTANCE outside *ASSEMBLY"));
    EXPECT_THAT(error("*End Part\n" + part), HasSubstr("deck.inp:1: *END PART that ends nothing"));
    EXPECT_THAT(error(assembly("*Instance, name=Old, instance=Cube-1, library=job\n*End Instance\n")),
                HasSubstr("*INSTANCE of another analysis"));
    EXPECT_THAT(error(assembly("*Instance, name=A, part=Cube\n")), HasSubstr("*END ASSEMBLY inside the *INSTANCE 'A'"));
}

} // namespace
} // namespace osculate::mesh::OSCULATE_THIS_FILE
