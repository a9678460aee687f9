#include "mesh/file_tests.hpp"
#include "osculate/mesh/gmsh.hpp"
#include "osculate/mesh/quality.hpp"

#include <cfenv>
#include <csignal>
#include <cstring>

namespace osculate::mesh {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Key;

/// A unit cube and a wedge on top of it, the ground and a corner in physical groups.
const std::string msh2 = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n"
                         "$PhysicalNames\n3\n0 5 \"corner\"\n2 2 \"ground\"\n3 1 \"steel\"\n$EndPhysicalNames\n"
                         "$Nodes\n10\n1 0 0 0\n2 1 0 0\n3 1 1 0\n4 0 1 0\n5 0 0 1\n6 1 0 1\n7 1 1 1\n8 0 1 1\n"
                         "19 0 .5 2\n20 1 .5 2\n$EndNodes\n"
                         "$Elements\n4\n1 15 2 5 1 1\n2 3 2 2 1 1 4 3 2\n7 5 2 1 1 1 2 3 4 5 6 7 8\n"
                         "8 6 2 3 2 5 8 19 6 7 20\n$EndElements\n";

const std::string msh4 = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n"
                         "$PhysicalNames\n2\n2 2 \"ground\"\n3 1 \"steel\"\n$EndPhysicalNames\n"
                         "$Entities\n0 0 1 1\n1 0 0 0 1 1 0 1 2 0\n1 0 0 0 1 1 1 1 1 1 1\n$EndEntities\n"
                         "$Nodes\n1 8 1 8\n3 1 0 8\n1\n2\n3\n4\n5\n6\n7\n8\n"
                         "0 0 0\n1 0 0\n1 1 0\n0 1 0\n0 0 1\n1 0 1\n1 1 1\n0 1 1\n$EndNodes\n"
                         "$Elements\n2 2 1 2\n2 1 3 1\n1 1 4 3 2\n3 1 5 1\n2 1 2 3 4 5 6 7 8\n$EndElements\n";

template <class T> std::string bytes(std::initializer_list<T> values) {
    std::string text(values.size() * sizeof(T), '\0');
    std::memcpy(text.data(), values.begin(), text.size());
    return text;
}

std::string binary2() {
    std::string text = "$MeshFormat\n2.2 1 8\n" + bytes<int>({1}) + "\n$EndMeshFormat\n$Nodes\n8\n";
    const double corner[8][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0},
                                 {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
    for (int n = 0; n < 8; ++n) text += bytes<int>({n + 1}) + bytes<double>({corner[n][0], corner[n][1], corner[n][2]});
    return text + "\n$EndNodes\n$Elements\n1\n" + bytes<int>({5, 1, 2, 7, 1, 1, 1, 2, 3, 4, 5, 6, 7, 8}) +
           "\n$EndElements\n";
}

std::string binary4() {
    using Size = std::size_t;
    std::string text = "$MeshFormat\n4.1 1 8\n" + bytes<int>({1}) + "\n$EndMeshFormat\n$Nodes\n";
    text += bytes<Size>({1, 8, 1, 8}) + bytes<int>({3, 1, 0}) + bytes<Size>({8, 1, 2, 3, 4, 5, 6, 7, 8});
    text += bytes<double>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0, 0, 0, 1, 1, 0, 1, 1, 1, 1, 0, 1, 1});
    text += "\n$EndNodes\n$Elements\n" + bytes<Size>({1, 1, 7, 7}) + bytes<int>({3, 1, 5}) + bytes<Size>({1});
    return text + bytes<Size>({7, 1, 2, 3, 4, 5, 6, 7, 8}) + "\n$EndElements\n";
}

class GmshFiles : public testing::FileTest {
protected:
    void SetUp() override {
        FileTest::SetUp();
        if (!OSCULATE_HAS_GMSH) GTEST_SKIP() << "built without Gmsh's library";
    }
};

TEST_F(GmshFiles, PhysicalGroupsAreSetsSurfacesAndParts) {
    const std::string path = write("block.msh", msh2);
    const Mesh mesh = mesh_of(path);
    EXPECT_EQ(mesh.node_count(), 10);
    EXPECT_EQ(mesh.element_count(), 2);
    EXPECT_THAT(faults(mesh), IsEmpty());
    ASSERT_EQ(mesh.surfaces.at("ground").size(), 1u);
    EXPECT_EQ(facet_normal(mesh.surfaces.at("ground")[0], mesh.nodes), Vec3(0, 0, -1));
    EXPECT_EQ(mesh.node_sets.at("corner"), std::vector<Index>{0});
    EXPECT_EQ(mesh_of(path, {"steel", 0, {}}).element_count(), 1);
    EXPECT_EQ(mesh_of(path, {"physical_3", 0, {}}).node_count(), 6);
}

TEST_F(GmshFiles, BothVersionsAndTheirBinariesAreRead) {
    for (const auto& [name, text] :
         {std::pair("ascii4.msh", msh4), std::pair("binary2.msh", binary2()), std::pair("binary4.msh", binary4())}) {
        const Mesh mesh = mesh_of(write(name, text));
        EXPECT_EQ(mesh.node_count(), 8) << name;
        EXPECT_EQ(mesh.element_count(), 1) << name;
        EXPECT_THAT(faults(mesh), IsEmpty()) << name;
    }
    EXPECT_EQ(mesh_of(write("ascii4.msh", msh4)).surfaces.at("ground").size(), 1u);
}

TEST_F(GmshFiles, FaultsNameTheFilesOwnNumbers) {
    std::string inverted = msh2;
    const std::string cube = "1 2 3 4 5 6 7 8\n";
    inverted.replace(inverted.find(cube), cube.size(), "5 6 7 8 1 2 3 4\n");
    EXPECT_THAT(error_of(write("inverted.msh", inverted)), HasSubstr("element 7 is inverted"));
}

TEST_F(GmshFiles, WhatGmshWouldTakeForAScriptOrForTooMuchIsRefusedBefore) {
    EXPECT_THAT(error_of(write("script.msh", "SystemCall \"touch here\";\n")), HasSubstr("not $MeshFormat"));
    EXPECT_THAT(error_of(write("old.msh", "$MeshFormat\n1.0 0 8\n$EndMeshFormat\n")), HasSubstr("version '1.0'"));
    EXPECT_THAT(error_of(write("cut.msh", msh2.substr(0, msh2.size() / 2))), HasSubstr("has no end"));
    std::string many = msh2;
    many.replace(many.find("$Nodes\n10"), 9, "$Nodes\n1000000000");
    EXPECT_THAT(error_of(write("many.msh", many)), HasSubstr("$Nodes announces more than it holds"));
    std::string block = msh4;
    block.replace(block.find("3 1 0 8\n"), 8, "3 1 0 800000000\n");
    EXPECT_THAT(error_of(write("block.msh", block)), HasSubstr("$Nodes has a block that announces more"));
    for (const char* names :
         {"1\n4 2 \"ground\"\n", "2\n3 1 \"steel\"\n", "ground\n"}) // no dimension, too few, no count
        EXPECT_THAT(error_of(write("names.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n" +
                                                    std::string(names) + "$EndPhysicalNames\n")),
                    HasSubstr("$PhysicalNames does not hold what it says"));
    std::string binary = binary4();
    binary[binary.find("$Elements") + 10 + 32 + 12 + 5] = 1; // 2^40 elements
    EXPECT_THAT(error_of(write("binary.msh", binary)), HasSubstr("$Elements has a block that announces more"));
    std::string missing = msh2;
    missing.replace(missing.find("6 7 20"), 6, "6 7 99");
    EXPECT_NE(error_of(write("missing.msh", missing)), "");
}

TEST_F(GmshFiles, SignalsTrapsAndTheTerminalStayAsTheyWere) {
    struct sigaction before {
    }, after{};
    sigaction(SIGSEGV, nullptr, &before);
    const int traps = fegetexcept(), rounding = fegetround();
    const std::string path = write("block.msh", msh2);
    EXPECT_EQ(error_of(path), "") << "nothing is printed";
    sigaction(SIGSEGV, nullptr, &after);
    EXPECT_EQ(before.sa_handler, after.sa_handler);
    EXPECT_EQ(fegetexcept(), traps);
    EXPECT_EQ(fegetround(), rounding);
}

TEST_F(GmshFiles, GeometryIsMeshedTheSameEveryTime) {
    const std::string brep = OSCULATE_SOURCE_DIR "/tests/mesh/data/quarter_cylinder.brep";
    CadOptions options{brep, 0.25, 0, 12, false};
    const RawMesh first = mesh_cad(options), second = mesh_cad(options);
    ASSERT_EQ(first.points.size(), second.points.size());
    EXPECT_EQ(first.points, second.points) << "to the last bit";
    const Mesh mesh = make_mesh(first);
    EXPECT_THAT(faults(mesh), IsEmpty());
    EXPECT_THAT(mesh.surfaces, Contains(Key("face_1")));
    double area = 0;
    Vec3 sum = Vec3::Zero();
    for (const auto& [name, facets] : mesh.surfaces)
        for (const Facet& facet : facets) {
            area += facet_area_vector(facet, mesh.nodes).norm();
            sum += facet_area_vector(facet, mesh.nodes);
        }
    EXPECT_NEAR(sum.norm(), 0, 1e-12) << "every face of the outside belongs to one surface";
    options.quadratic = true;
    const Mesh quadratic = make_mesh(mesh_cad(options));
    EXPECT_EQ(quadratic.blocks[0].type, CellType::tet10);
    EXPECT_THAT(faults(quadratic), IsEmpty());
    double curved = 0;
    for (const auto& [name, facets] : quadratic.surfaces)
        for (const Facet& facet : facets) curved += facet_area_vector(facet, quadratic.nodes).norm();
    EXPECT_GT(curved, area) << "middle nodes stand on the round face";
}

} // namespace
} // namespace osculate::mesh
