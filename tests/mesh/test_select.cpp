#include "mesh/shapes.hpp"
#include "osculate/mesh/select.hpp"

#include <algorithm>
#include <gmock/gmock.h>

namespace osculate::mesh::OSCULATE_THIS_FILE {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::SizeIs;

std::vector<std::array<Index, 4>> facet_nodes(const std::vector<Facet>& facets) {
    std::vector<std::array<Index, 4>> nodes;
    for (const Facet& facet : facets) nodes.push_back(facet.nodes);
    std::sort(nodes.begin(), nodes.end());
    return nodes;
}

/// A tube turned and moved, so that no direction is special.
class PlacedTube : public ::testing::Test {
protected:
    const Vec3 axis{1, 2, 3}, translation{5, -4, 7};
    const double angle = 0.7;
    Mesh mesh = [this] {
        Mesh tube = make_half_tube(3, 1, 12, {13, 12, 3}, CellType::wedge6);
        place(tube, axis, angle, translation, 1);
        return tube;
    }();
    std::vector<Facet> exterior = exterior_facets(mesh);
    Mat3 rotation = Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
};

TEST_F(PlacedTube, IsSelectedByCylinder) {
    for (const auto& [name, radius] : {std::pair("inner", 3.0), std::pair("outer", 4.0)}) {
        const Region region = select_cylinder(mesh, exterior, translation, rotation.col(1) * 2, radius);
        EXPECT_EQ(facet_nodes(region.facets), facet_nodes(mesh.surfaces.at(name)));
        EXPECT_THAT(region.nodes, SizeIs(14 * 13));
    }
    const Region between = select_cylinder(mesh, exterior, translation, rotation.col(1), 3 + 1.0 / 3);
    EXPECT_THAT(between.facets, IsEmpty());
    EXPECT_THAT(between.nodes, SizeIs(14 * 13)) << "inner nodes count";
    EXPECT_THAT(select_cylinder(mesh, exterior, translation, rotation.col(1), 3.1).nodes, IsEmpty());
}

TEST_F(PlacedTube, IsSelectedByPlane) {
    const Region end = select_plane(mesh, exterior, translation + 12 * rotation.col(1), -3 * rotation.col(1));
    EXPECT_EQ(facet_nodes(end.facets), facet_nodes(mesh.surfaces.at("y_max")));
    EXPECT_THAT(end.nodes, SizeIs(14 * 4));
    const Region rims = select_plane(mesh, exterior, translation, rotation.col(2));
    EXPECT_THAT(rims.facets, SizeIs(2 * 12 * 3));
    const Region cut = select_plane(mesh, exterior, translation + 6 * rotation.col(1), rotation.col(1));
    EXPECT_THAT(cut.facets, IsEmpty());
    EXPECT_THAT(cut.nodes, SizeIs(14 * 4));
}

TEST_F(PlacedTube, KnowsTheSurfaceNearestToAPoint) {
    const auto near = [&](const Vec3& x) { return nearest_surfaces(mesh, translation + rotation * x); };
    EXPECT_THAT(near({0, 6, -2.9}), ElementsAre("inner")) << "beside it";
    EXPECT_THAT(near({0, 6, -100}), ElementsAre("outer")) << "far away, and still the nearest";
    EXPECT_THAT(near({0, 12.1, -3.5}), ElementsAre("y_max"));
    EXPECT_THAT(near({0, 12, -4}), ElementsAre("outer", "y_max")) << "the edge between them";
    mesh.surfaces["all"] = exterior;
    EXPECT_THAT(near({0, 6, -2.9}), ElementsAre("inner")) << "the smallest that is there";
    mesh.surfaces["an_alias"] = mesh.surfaces.at("inner");
    EXPECT_THAT(near({0, 6, -2.9}), ElementsAre("an_alias")) << "of equal ones the first";
    mesh.surfaces.clear();
    EXPECT_THAT(near({0, 6, -2.9}), IsEmpty());
}

TEST_F(PlacedTube, KnowsTheNodeNearestToAPoint) {
    const auto inside = static_cast<Index>(mesh.nodes.size()) / 2;
    const Vec3 X = mesh.nodes[static_cast<std::size_t>(inside)];
    EXPECT_THAT(nearest_nodes(mesh, X), ElementsAre(inside));
    EXPECT_THAT(nearest_nodes(mesh, X + Vec3(0.01, -0.02, 0.01)), ElementsAre(inside));
    const Vec3 other = mesh.nodes[static_cast<std::size_t>(inside) + 1];
    EXPECT_THAT(nearest_nodes(mesh, 0.5 * (X + other)), ElementsAre(inside, inside + 1)) << "as near";
    mesh.nodes.clear();
    EXPECT_THAT(nearest_nodes(mesh, X), IsEmpty());
}

TEST_F(PlacedTube, IsSelectedByNormal) {
    const Region end = select_normal(mesh, exterior, rotation.col(1) * 5, 0.1);
    EXPECT_EQ(facet_nodes(end.facets), facet_nodes(mesh.surfaces.at("y_max")));
    EXPECT_THAT(end.nodes, SizeIs(14 * 4));
    EXPECT_TRUE(std::is_sorted(end.nodes.begin(), end.nodes.end()));
    // Downward within one and a half facets' turn: the lowest facet of the outer surface and one on either side.
    const double facet_turn = std::numbers::pi / 13;
    EXPECT_THAT(select_normal(mesh, exterior, -rotation.col(2), 1.5 * facet_turn).facets, SizeIs(3 * 12 * 2));
}

TEST(Select, TakesABoxWithItsSurface) {
    const Mesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {4, 4, 4});
    const auto exterior = exterior_facets(mesh);
    const Region corner = select_box(mesh, exterior, {0, 0, 0}, {0.5, 0.5, 0.5});
    EXPECT_THAT(corner.nodes, SizeIs(27));
    EXPECT_THAT(corner.facets, SizeIs(3 * 4));
    EXPECT_THAT(select_box(mesh, exterior, {0.2, 0.2, 0.2}, {0.8, 0.8, 0.8}).facets, IsEmpty());
    EXPECT_THAT(select_box(mesh, exterior, {0.2, 0.2, 0.2}, {0.8, 0.8, 0.8}).nodes, SizeIs(27));
}

TEST(Select, ScalesItsToleranceWithTheMesh) {
    for (const double size : {1e-6, 1.0, 1e6}) {
        const Mesh mesh = make_block({0, 0, 0}, {size, size, size}, {2, 2, 2});
        const auto exterior = exterior_facets(mesh);
        const double diagonal = std::sqrt(3.0) * size;
        const auto off = [&](double distance) {
            return select_plane(mesh, exterior, {0, 0, size + distance * diagonal}, {0, 0, 1}).facets.size();
        };
        EXPECT_EQ(off(0.5 * selection_tolerance), 4u);
        EXPECT_EQ(off(2 * selection_tolerance), 0u);
        const auto within = [&](double distance) { // of a box that is smaller by this on all sides
            const Vec3 less = Vec3::Constant(distance * diagonal);
            return select_box(mesh, exterior, less, Vec3::Constant(size) - less).facets.size();
        };
        EXPECT_EQ(within(0.5 * selection_tolerance), 24u);
        EXPECT_EQ(within(2 * selection_tolerance), 0u);
    }
}

TEST(Select, LeavesOutTheEndsOfASolidCylinder) {
    // A block of one column has all its corners on a cylinder; only its four sides follow it.
    const Mesh mesh = make_block({-1, -1, 0}, {2, 2, 3}, {1, 1, 2});
    const Region region = select_cylinder(mesh, exterior_facets(mesh), {0, 0, 0}, {0, 0, 1}, std::sqrt(2.0));
    EXPECT_THAT(region.facets, SizeIs(8));
}

TEST(Select, FindsNamedSurfacesAndNodeSets) {
    Mesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {2, 2, 2});
    const auto exterior = exterior_facets(mesh);
    const auto top = select_named(mesh, exterior, "z_max");
    ASSERT_TRUE(top.has_value());
    EXPECT_EQ(facet_nodes(top->facets), facet_nodes(mesh.surfaces.at("z_max")));
    EXPECT_THAT(top->nodes, SizeIs(9));
    mesh.node_sets["lid"] = top->nodes;
    const auto lid = select_named(mesh, exterior, "lid");
    ASSERT_TRUE(lid.has_value());
    EXPECT_EQ(facet_nodes(lid->facets), facet_nodes(top->facets));
    EXPECT_EQ(lid->nodes, top->nodes);
    EXPECT_FALSE(select_named(mesh, exterior, "bottom").has_value());
}

} // namespace
} // namespace osculate::mesh::OSCULATE_THIS_FILE
