#include "mesh/file_tests.hpp"
#include "osculate/mesh/cad_listing.hpp"
#include "osculate/mesh/gmsh.hpp"
#include "osculate/mesh/quality.hpp"
#include "support/source_tree.hpp"

#include <cfenv>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <dlfcn.h>
#include <map>
#include <numbers>

namespace osculate::mesh::OSCULATE_THIS_FILE {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
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

std::string changed(std::string text, const std::string& from, const std::string& to) {
    return text.replace(text.find(from), from.size(), to);
}

class GmshFiles : public fixtures::FileTest {
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
    // entities that other writers number from 0
    const std::string zero = changed(changed(binary4(), bytes<int>({3, 1, 0}), bytes<int>({3, 0, 0})),
                                     bytes<int>({3, 1, 5}), bytes<int>({3, 0, 5}));
    EXPECT_EQ(mesh_of(write("zero.msh", zero), {"volume_0", 0, {}}).element_count(), 1);
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
    EXPECT_THAT(error_of(write("cut.msh", msh2.substr(0, msh2.size() / 2))),
                HasSubstr("line 17, section $Nodes: expected a coordinate, found ''"));
    EXPECT_THAT(error_of(write("many.msh", changed(msh2, "$Nodes\n10", "$Nodes\n1000000000"))),
                HasSubstr("line 22, section $Nodes: expected the number of a node, found '$EndNodes'"));
    EXPECT_THAT(error_of(write("block.msh", changed(msh4, "3 1 0 8\n", "3 1 0 800000000\n"))),
                HasSubstr("the number of nodes of a block is 800000000, not from 0 to 8"));
    for (const auto& [names, fault] : {std::pair("1\n4 2 \"ground\"\n", "the dimension of a name is 4"),
                                       std::pair("2\n3 1 \"steel\"\n", "found '$EndPhysicalNames'"),
                                       std::pair("ground\n", "expected the number of names, found 'ground'"),
                                       std::pair("1\n3 1 \"steel\n", "in double quotes, found ' \"steel'")})
        EXPECT_THAT(error_of(write("names.msh", "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n$PhysicalNames\n" +
                                                    std::string(names) + "$EndPhysicalNames\n")),
                    HasSubstr(fault));
    std::string binary = binary4();
    binary[binary.find("$Elements") + 10 + 32 + 12 + 5] = 1; // 2^40 elements
    EXPECT_THAT(
        error_of(write("binary.msh", binary)),
        AllOf(HasSubstr("byte "), HasSubstr("the number of elements of a block is 1099511627777, not from 0 to 1")));
    EXPECT_THAT(error_of(write("missing.msh", changed(msh2, "6 7 20", "6 7 99"))),
                HasSubstr("line 28, section $Elements: element 8 has node 99, which does not exist"));
    EXPECT_THAT(error_of(write("twice.msh", changed(msh2, "\n20 1 .5 2", "\n19 1 .5 2"))),
                HasSubstr("node 19 is there twice"));
    EXPECT_THAT(error_of(write("infinite.msh", changed(msh2, "1 .5 2", "inf .5 2"))),
                HasSubstr("a coordinate is not finite"));
    EXPECT_THAT(error_of(write("bounds.msh", changed(msh4, "1 1 1 1 1 1 1\n$End", "1 1 1 1 1 1 9\n$End"))),
                HasSubstr("entity 1 is bounded by 9, which does not exist"));
    EXPECT_THAT(error_of(write("greatest.msh", changed(msh4, "1 8 1 8\n", "1 8 1 9\n"))),
                HasSubstr("numbers of nodes are from 1 to 8, announced are 1 to 9"));
    EXPECT_THAT(error_of(write("parametric.msh", changed(changed(msh2, "$Nodes", "$ParametricNodes"), "$EndNodes",
                                                         "$EndParametricNodes"))),
                HasSubstr("section $ParametricNodes: nodes with parameters are read in version 4.1 only"));
    EXPECT_THAT(error_of(write("no_elements.msh", msh2.substr(0, msh2.find("$Elements")))),
                HasSubstr("ends without a section $Elements"));
}

TEST_F(GmshFiles, ElementsOfOtherShapesAreNamed) {
    EXPECT_THAT(error_of(write("pyramid.msh", changed(msh2, "8 6 2 3 2 5 8 19 6 7 20", "8 7 2 3 2 5 6 7 8 19"))),
                AllOf(HasSubstr("element 8 is a Pyramid 5"), HasSubstr("only hex8, wedge6, tet4")));
}

TEST_F(GmshFiles, SectionsThatNothingIsTakenFromAreLeftOut) {
    const std::string other = "$NodeData\n1\n\"not even a whole one\"\n$EndNodeData\n";
    const Mesh mesh = mesh_of(write("more.msh", changed(msh2, "$Nodes\n", other + "$Nodes\n") + other));
    EXPECT_EQ(mesh.node_count(), 10);
    EXPECT_EQ(mesh.element_count(), 2);
    EXPECT_THAT(error_of(write("open.msh", msh2 + "$NodeData\n1\n")), HasSubstr("section $NodeData: has no end"));
    EXPECT_EQ(mesh_of(write("whole.msh", changed(msh2, "7 5 2 1 1 1", "7 5 3 1 1 0 1"))).element_count(), 2);
    EXPECT_THAT(error_of(write("cut2.msh", changed(msh2, "7 5 2 1 1 1", "7 5 4 1 1 1 1 1"))),
                HasSubstr("line 27, section $Elements: the mesh is cut into partitions"));
    EXPECT_THAT(error_of(write("cut.msh", msh4 + "$PartitionedEntities\n2\n$EndPartitionedEntities\n")),
                HasSubstr("cut into partitions; save it whole"));
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

TEST_F(GmshFiles, ModelsAndOptionsOfAHostThatUsesGmshStay) {
    (void)read_gmsh(write("block.msh", msh2)); // loads and initialises the library
    void* gmsh = dlopen("libgmsh.so", RTLD_NOW);
    ASSERT_NE(gmsh, nullptr);
    const auto add = reinterpret_cast<void (*)(const char*, int*)>(dlsym(gmsh, "gmshModelAdd"));
    const auto current = reinterpret_cast<void (*)(char**, int*)>(dlsym(gmsh, "gmshModelGetCurrent"));
    const auto set = reinterpret_cast<void (*)(const char*, double, int*)>(dlsym(gmsh, "gmshOptionSetNumber"));
    const auto get = reinterpret_cast<void (*)(const char*, double*, int*)>(dlsym(gmsh, "gmshOptionGetNumber"));
    int error = 0;
    add("the host's", &error);
    set("General.Terminal", 0, &error);
    set("General.NumThreads", 2, &error);
    EXPECT_EQ(error_of(write("block.msh", msh2)), "");
    char* name = nullptr;
    double threads = 0;
    current(&name, &error);
    get("General.NumThreads", &threads, &error);
    EXPECT_STREQ(name, "the host's");
    EXPECT_EQ(threads, 2);
    EXPECT_EQ(error, 0);
    std::free(name);
    set("General.NumThreads", 1, &error);
}

TEST_F(GmshFiles, GeometryIsMeshedTheSameEveryTime) {
    const std::string brep = support::source_tree() + "/tests/mesh/data/quarter_cylinder.brep";
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

/// A quarter of a cylinder of radius 0.5 and length 1: all of its measures are known.
TEST_F(GmshFiles, GeometryIsListedWithItsMeasures) {
    constexpr double pi = std::numbers::pi, exact = 1e-9;
    const CadListing listing = list_cad(support::source_tree() + "/tests/mesh/data/quarter_cylinder.brep");
    ASSERT_EQ(listing.solids.size(), 1U);
    EXPECT_NEAR(listing.solids[0].measure, pi / 16, exact);
    const double middle = 4 * 0.5 / (3 * pi); // of mass, of a quarter of a disc
    EXPECT_LT((listing.solids[0].centre - Vec3(middle, middle, 0.5)).norm(), exact);
    std::map<std::string, double> areas;
    for (const CadEntity& face : listing.faces) {
        areas[face.type] += face.measure;
        EXPECT_THAT(face.of, ElementsAre(1));
        if (face.type != "Cylinder") continue;
        EXPECT_NEAR(face.radius, 0.5, exact);
        EXPECT_LT((face.axis - Vec3::UnitZ()).norm(), exact);
    }
    EXPECT_NEAR(areas["Cylinder"], pi / 4, exact);
    EXPECT_NEAR(areas["Plane"], 2 * pi / 16 + 2 * 0.5, exact);
    double length = 0;
    for (const CadEntity& edge : listing.edges) {
        length += edge.measure;
        EXPECT_EQ(edge.of.size(), 2U) << "faces on both sides";
        EXPECT_NEAR(edge.radius, edge.type == "Circle" ? 0.5 : 0, exact);
    }
    EXPECT_NEAR(length, 2 * pi / 4 + 3 + 4 * 0.5, exact);
    double flat = 0;
    for (std::size_t f = 0; f < listing.faces.size(); ++f)
        for (const auto& [a, b, c] : listing.triangles[f]) {
            const auto at = [&](int p) { return listing.points[static_cast<std::size_t>(p)]; };
            flat += 0.5 * (at(b) - at(a)).cross(at(c) - at(a)).norm();
        }
    EXPECT_NEAR(flat, 2 * pi / 16 + 1 + pi / 4, 0.02) << "triangles cover the faces";
}

/// STEP states its unit, which is not the metre.
TEST_F(GmshFiles, GeometryIsListedInMetres) {
    const CadListing listing = list_cad(support::source_tree() + "/configs/tutorials/geometry/bracket.step");
    constexpr double pi = std::numbers::pi;
    // a foot with two holes of 7 mm, a lug that ends in half a disc, its hole of 12 mm
    const double volume = 60 * 40 * 8 - 2 * pi * 3.5 * 3.5 * 8 + 30 * 24 * 8 + pi * 15 * 15 / 2 * 8 - pi * 36 * 8;
    EXPECT_NEAR(listing.solids.at(0).measure, 1e-9 * volume, 1e-9 * 1e-6 * volume);
    int holes = 0;
    for (const CadEntity& face : listing.faces)
        holes += face.type == "Cylinder" && std::abs(face.radius - 0.0035) < 1e-9;
    EXPECT_EQ(holes, 2);
}

TEST_F(GmshFiles, GeometryThatIsNoneIsNamed) {
    const auto fault = [](const std::string& path) -> std::string {
        try {
            (void)list_cad(path);
        } catch (const MeshError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_THAT(fault(write("none.step", "nothing")), HasSubstr("none.step"));
    EXPECT_THAT(fault("nowhere.step"), HasSubstr("no such file"));
}

TEST_F(GmshFiles, ElementsAreSmallAroundAFocusAndGrowAwayFromIt) {
    const std::string brep = support::source_tree() + "/tests/mesh/data/quarter_cylinder.brep";
    CadOptions options{brep, 0.25};
    const std::size_t even = make_mesh(mesh_cad(options)).nodes.size();
    options.focus = {.point = {0.5, 0, 1}, .size = 0.02, .extent = 0.1, .growth = 1.3};
    const Mesh mesh = make_mesh(mesh_cad(options));
    EXPECT_THAT(faults(mesh), IsEmpty());
    EXPECT_GT(mesh.nodes.size(), 2 * even);
    constexpr double longest = 2.5, mean = 1.35; // of free meshes, times what is asked for
    double ratio = 0;
    int near = 0;
    for (std::size_t e = 0; e < mesh.blocks[0].connectivity.size(); e += 4)
        for (std::size_t a = 0; a < 4; ++a)
            for (std::size_t b = 0; b < a; ++b) {
                const Vec3& p = mesh.nodes[static_cast<std::size_t>(mesh.blocks[0].connectivity[e + a])];
                const Vec3& q = mesh.nodes[static_cast<std::size_t>(mesh.blocks[0].connectivity[e + b])];
                const double distance = ((p + q) / 2 - options.focus.point).norm();
                EXPECT_LT((p - q).norm(), longest * options.focus.size_at(distance, options.size));
                if (distance < options.focus.extent) {
                    ratio += (p - q).norm() / options.focus.size;
                    ++near;
                }
            }
    ASSERT_GT(near, 0);
    EXPECT_LT(ratio / near, mean);
    EXPECT_GT(ratio / near, 1 / mean);
}

TEST_F(GmshFiles, ElementsLargerThanATenthOfTheGeometryAreMadeWhereCurvesLetThem) {
    const std::string brep = support::source_tree() + "/tests/mesh/data/quarter_cylinder.brep"; // 1.22 across
    const auto nodes = [&](double size, int per_circle) {
        const Mesh mesh = make_mesh(mesh_cad({brep, size, 0, per_circle}));
        EXPECT_THAT(faults(mesh), IsEmpty());
        return mesh.nodes;
    };
    const std::size_t usual = nodes(0, 0).size(), larger = nodes(0.25, 0).size();
    EXPECT_LT(larger, usual / 2);
    EXPECT_LT(nodes(0.4, 0).size(), larger);
    int on_arc = 0;
    for (const Vec3& x : nodes(0.4, 48)) on_arc += std::abs(x.z()) < 1e-9 && std::abs(x.head<2>().norm() - 0.5) < 1e-6;
    EXPECT_GE(on_arc, 48 / 4 + 1);
    EXPECT_LE(on_arc, 2 * 48 / 4 + 1);
}

TEST_F(GmshFiles, ElementsAreSmallAtSurfacesInContactAndGrowAwayFromThem) {
    const std::string brep = support::source_tree() + "/tests/mesh/data/quarter_cylinder.brep";
    CadOptions options{brep, 0.1};
    const std::size_t even = make_mesh(mesh_cad(options)).nodes.size();
    options.contact = {.size = 0.02, .growth = 1.4};
    EXPECT_EQ(make_mesh(mesh_cad(options)).nodes.size(), even) << "nothing is met";
    options.meeting = {{Vec3(0, 0, 0), Vec3(0.2, 0, 0), Vec3(0.2, 0.2, 0)},
                       {Vec3(0, 0, 0), Vec3(0.2, 0.2, 0), Vec3(0, 0.2, 0)}};
    const auto asked = [&](const Vec3& x) { // the distance from a square
        const Vec3 foot(std::clamp(x.x(), 0.0, 0.2), std::clamp(x.y(), 0.0, 0.2), 0);
        return std::min(options.size, options.contact.size + (options.contact.growth - 1) * (x - foot).norm());
    };
    const Mesh mesh = make_mesh(mesh_cad(options));
    EXPECT_THAT(faults(mesh), IsEmpty());
    EXPECT_GT(mesh.nodes.size(), 2 * even);
    constexpr double longest = 2.5, mean = 1.35; // of free meshes, times what is asked for
    double at_contact = 0, elsewhere = 0;
    int near = 0, far = 0;
    for (std::size_t e = 0; e < mesh.blocks[0].connectivity.size(); e += 4)
        for (std::size_t a = 0; a < 4; ++a)
            for (std::size_t b = 0; b < a; ++b) {
                const Vec3& p = mesh.nodes[static_cast<std::size_t>(mesh.blocks[0].connectivity[e + a])];
                const Vec3& q = mesh.nodes[static_cast<std::size_t>(mesh.blocks[0].connectivity[e + b])];
                const double ratio = (p - q).norm() / asked((p + q) / 2);
                EXPECT_LT(ratio, longest);
                if (asked(p) == options.contact.size && asked(q) == options.contact.size) {
                    at_contact += ratio;
                    ++near;
                } else {
                    elsewhere += ratio;
                    ++far;
                }
            }
    ASSERT_GT(near, 0);
    ASSERT_GT(far, 0);
    for (const double ratio : {at_contact / near, elsewhere / far}) {
        EXPECT_LT(ratio, mean);
        EXPECT_GT(ratio, 1 / mean);
    }
    options.contact.size = 1e-5;
    EXPECT_THROW((void)mesh_cad(options), MeshError) << "too many elements";
}

TEST_F(GmshFiles, AFocusWhoseElementsWouldBeTooManyIsRefused) {
    const std::string brep = support::source_tree() + "/tests/mesh/data/quarter_cylinder.brep";
    CadOptions options{brep, 0.25};
    for (const CadFocus& focus : {CadFocus{.point = {0.5, 0, 1}, .size = 1e-4, .extent = 0.1},
                                  CadFocus{.point = {0.5, 0, 1}, .size = 1e-9, .growth = 1},
                                  CadFocus{.point = {50, 0, 0}, .size = 1e-3, .extent = 100}}) {
        options.focus = focus;
        EXPECT_THROW((void)mesh_cad(options), MeshError);
    }
    options.focus = {.point = {50, 0, 0}, .size = 1e-3, .extent = 1};
    EXPECT_NO_THROW((void)mesh_cad(options)) << "far from the geometry";
}

} // namespace
} // namespace osculate::mesh::OSCULATE_THIS_FILE
