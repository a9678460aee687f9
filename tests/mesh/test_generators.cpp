#include "mesh/shapes.hpp"
#include "osculate/mesh/quality.hpp"
#include "support/floating_point_traps.hpp"

#include <gmock/gmock.h>
#include <limits>
#include <map>
#include <set>
#include <stdexcept>
#include <tuple>

namespace osculate::mesh::OSCULATE_THIS_FILE {
namespace {

using fixtures::all_shapes;
using fixtures::Shape;
using ::testing::IsEmpty;

constexpr double round_off = 1e-12; ///< relative; sums of a few hundred terms of order one

std::vector<Index> key(const Facet& facet) {
    std::vector<Index> nodes(facet.begin(), facet.end());
    std::sort(nodes.begin(), nodes.end());
    return nodes;
}

double sum_of_cells(const Mesh& mesh) {
    double sum = 0;
    for (const ElementBlock& block : mesh.blocks) {
        const auto stride = static_cast<std::size_t>(nodes_per_cell(block.type));
        for (Index e = 0; e < block.size(); ++e)
            sum += cell_volume(block.type, {block.connectivity.data() + e * stride, stride}, mesh.nodes);
    }
    return sum;
}

TEST(EveryShape, HasTheExactVolumeInsideAnOutwardSurface) {
    for (const Shape& shape : all_shapes()) {
        SCOPED_TRACE(shape.name);
        const auto& [name, mesh, volume, area] = shape;
        const auto exterior = fixtures::integrate(exterior_facets(mesh), mesh.nodes);
        EXPECT_NEAR(exterior.volume, volume, round_off * volume);
        EXPECT_LT(exterior.area_vector.norm(), round_off * exterior.area);
        EXPECT_NEAR(sum_of_cells(mesh), volume, round_off * volume);
    }
}

TEST(EveryShape, HasAClosedExteriorLikeASphere) {
    for (const Shape& shape : all_shapes()) {
        SCOPED_TRACE(shape.name);
        const Mesh& mesh = shape.mesh;
        const auto facets = exterior_facets(mesh);
        std::set<Index> vertices;
        std::map<std::pair<Index, Index>, int> edges; // directed sum: +1 and -1 cancel on a closed oriented surface
        std::map<std::pair<Index, Index>, int> uses;
        for (const Facet& facet : facets)
            for (int i = 0; i < facet.count; ++i) {
                const Index a = facet.nodes[i], b = facet.nodes[(i + 1) % facet.count];
                vertices.insert(a);
                edges[std::minmax(a, b)] += a < b ? 1 : -1;
                ++uses[std::minmax(a, b)];
            }
        for (const auto& [edge, sum] : edges) EXPECT_EQ(sum, 0);
        for (const auto& [edge, count] : uses) EXPECT_EQ(count, 2);
        EXPECT_EQ(vertices.size() - edges.size() + facets.size(), 2u);
    }
}

/// A crack between elements that do not match would show as facets strictly inside the body. Every quadrilateral of
/// these exteriors is plane, so that cutting it leaves its area as it is.
TEST(EveryShape, ConformsWithinAndIsSound) {
    for (const Shape& shape : all_shapes()) {
        SCOPED_TRACE(shape.name);
        const Mesh& mesh = shape.mesh;
        EXPECT_THAT(faults(mesh), IsEmpty());
        const double area = shape.area;
        EXPECT_NEAR(fixtures::integrate(exterior_facets(mesh), mesh.nodes).area, area, round_off * area);
    }
}

TEST(EveryShape, HasNamedSurfacesThatPartitionTheExterior) {
    for (const Shape& shape : all_shapes()) {
        SCOPED_TRACE(shape.name);
        const Mesh& mesh = shape.mesh;
        std::map<std::vector<Index>, Facet> exterior;
        for (const Facet& facet : exterior_facets(mesh)) exterior.emplace(key(facet), facet);
        EXPECT_EQ(mesh.surfaces.size(), 6u);
        std::size_t count = 0;
        for (const auto& [name, facets] : mesh.surfaces) {
            EXPECT_FALSE(facets.empty()) << name;
            for (const Facet& facet : facets) {
                const auto found = exterior.find(key(facet));
                ASSERT_NE(found, exterior.end()) << name;
                EXPECT_EQ(found->second.nodes, facet.nodes);
                EXPECT_EQ(found->second.block, facet.block);
                EXPECT_EQ(found->second.element, facet.element);
                ++count;
            }
        }
        EXPECT_EQ(count, exterior.size());
    }
}

TEST(EveryShape, HasFacetsThatBelongToTheirElement) {
    for (const Shape& shape : all_shapes()) {
        SCOPED_TRACE(shape.name);
        const Mesh& mesh = shape.mesh;
        for (const Facet& facet : exterior_facets(mesh)) {
            const ElementBlock& block = mesh.blocks.at(facet.block);
            const int stride = nodes_per_cell(block.type);
            const auto first = block.connectivity.begin() + facet.element * stride;
            for (const Index node : facet) EXPECT_NE(std::find(first, first + stride, node), first + stride);
        }
    }
}

/// Mean outward normal of a named surface.
Vec3 mean_normal(const Mesh& mesh, const std::string& surface) {
    return fixtures::integrate(mesh.surfaces.at(surface), mesh.nodes).area_vector.normalized();
}

TEST(Block, NamesItsSidesByDirection) {
    const Mesh mesh = make_block({0, 0, 0}, {1, 2, 3}, {2, 2, 2});
    for (int d = 0; d < 3; ++d) {
        const std::string axis(1, "xyz"[d]);
        EXPECT_LT((mean_normal(mesh, axis + "_min") + Vec3::Unit(d)).norm(), round_off);
        EXPECT_LT((mean_normal(mesh, axis + "_max") - Vec3::Unit(d)).norm(), round_off);
    }
}

std::pair<int, int> triangles_and_quads(const std::vector<Facet>& facets) {
    std::pair<int, int> count{0, 0};
    for (const Facet& facet : facets) ++(facet.count == 3 ? count.first : count.second);
    return count;
}

TEST(Block, TrianglePatternHasAlternatingDiagonals) {
    const Mesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {2, 2, 1}, CellType::hex8, BlockPattern::triangle);
    EXPECT_EQ(triangles_and_quads(mesh.surfaces.at("z_max")), std::pair(8, 0));
    EXPECT_EQ(mesh.blocks.size(), 1u);
    EXPECT_EQ(mesh.blocks[0].type, CellType::wedge6);
    // All four diagonals meet at the centre node: every triangle has it as a corner.
    std::map<Index, int> uses;
    for (const Facet& facet : mesh.surfaces.at("z_max"))
        for (const Index node : facet) ++uses[node];
    const Index centre = 9 + 4;
    EXPECT_EQ(uses.at(centre), 8);
    EXPECT_EQ(uses.at(9), 2);
    EXPECT_EQ(make_block({0, 0, 0}, {1, 1, 1}, {2, 2, 1}, CellType::wedge6).blocks[0].connectivity,
              mesh.blocks[0].connectivity);
}

TEST(Block, TetrahedraHaveAlternatingDiagonalsOnEverySide) {
    const Mesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {2, 2, 2}, CellType::tet4);
    for (const auto& [name, facets] : mesh.surfaces) {
        std::map<Index, int> uses;
        for (const Facet& facet : facets)
            for (const Index node : facet) ++uses[node];
        int most = 0;
        for (const auto& [node, count] : uses) most = std::max(most, count);
        EXPECT_EQ(most, 8) << name << ": the middle node is a corner of every triangle";
    }
}

TEST(Tet10, IsTheTetrahedronOfTheSameBlockWithANodeMidwayOnEveryEdge) {
    const Mesh linear = make_block({0, 0, 0}, {1, 2, 3}, {3, 2, 2}, CellType::tet4);
    const Mesh mesh = make_block({0, 0, 0}, {1, 2, 3}, {3, 2, 2}, CellType::tet10);
    EXPECT_EQ(mesh.node_count(), 7 * 5 * 5);
    ASSERT_EQ(mesh.element_count(), linear.element_count());
    constexpr int edges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};
    for (Index e = 0; e < mesh.element_count(); ++e) {
        const Index* nodes = mesh.blocks[0].connectivity.data() + 10 * e;
        for (int c = 0; c < 4; ++c)
            EXPECT_LT((mesh.nodes[nodes[c]] - linear.nodes[linear.blocks[0].connectivity[4 * e + c]]).norm(), 1e-15);
        for (int m = 0; m < 6; ++m) {
            const Vec3 middle = (mesh.nodes[nodes[edges[m][0]]] + mesh.nodes[nodes[edges[m][1]]]) / 2;
            EXPECT_LT((mesh.nodes[nodes[4 + m]] - middle).norm(), 1e-15);
        }
    }
}

TEST(Tet10, HasFourFacetsPerFaceWithEveryNodeOfTheSurfaceAsACorner) {
    const Mesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {2, 1, 1}, CellType::tet10);
    EXPECT_EQ(mesh.surfaces.at("z_max").size(), 2u * 2 * 4);
    std::set<Index> nodes;
    for (const Facet& facet : mesh.surfaces.at("z_max")) nodes.insert(facet.begin(), facet.end());
    EXPECT_EQ(nodes.size(), 5u * 3);
}

TEST(Tet10, PutsMidsideNodesOnTheTrueCylinder) {
    const Mesh mesh = make_half_tube(3, 1, 12, {4, 2, 2}, CellType::tet10);
    for (const auto& [name, radius] : {std::pair("inner", 3.0), std::pair("outer", 4.0)})
        for (const Facet& facet : mesh.surfaces.at(name))
            for (const Index n : facet)
                EXPECT_NEAR(std::hypot(mesh.nodes[n].x(), mesh.nodes[n].z()), radius, round_off);
}

TEST(Block, HybridPatternMixesAboutHalfOfEachReproducibly) {
    const auto make = [] {
        return make_block({0, 0, 0}, {1, 1, 1}, {25, 25, 2}, CellType::hex8, BlockPattern::hybrid);
    };
    const Mesh mesh = make();
    EXPECT_EQ(triangles_and_quads(mesh.surfaces.at("z_max")), std::pair(2 * 312, 313));
    EXPECT_EQ(mesh.blocks.size(), 2u);
    EXPECT_EQ(mesh.blocks[1].connectivity, make().blocks[1].connectivity);
    // Side by side: many edges of the top have a triangle on one side and a quadrilateral on the other.
    std::map<std::pair<Index, Index>, int> corners;
    for (const Facet& facet : mesh.surfaces.at("z_max"))
        for (int i = 0; i < facet.count; ++i)
            corners[std::minmax(facet.nodes[i], facet.nodes[(i + 1) % facet.count])] += facet.count;
    int mixed = 0;
    for (const auto& [edge, sum] : corners) mixed += sum == 7;
    EXPECT_GT(mixed, 2 * 25 * 24 / 3) << "of 1200 inner edges about half are mixed in a random arrangement";
}

TEST(HalfTube, LiesBelowItsAxisBetweenItsRadii) {
    const Mesh mesh = make_half_tube(3, 1, 12, {13, 12, 3});
    EXPECT_EQ(mesh.node_count(), 14 * 13 * 4);
    EXPECT_EQ(mesh.element_count(), 13 * 12 * 3);
    for (const Vec3& x : mesh.nodes) {
        EXPECT_LE(x.z(), 0);
        EXPECT_NEAR(std::clamp(std::hypot(x.x(), x.z()), 3.0, 4.0), std::hypot(x.x(), x.z()), 1e-14);
    }
    for (const auto& [name, radius] : {std::pair("inner", 3.0), std::pair("outer", 4.0)})
        for (const Facet& facet : mesh.surfaces.at(name)) {
            for (const Index node : facet)
                EXPECT_NEAR(std::hypot(mesh.nodes[node].x(), mesh.nodes[node].z()), radius, 1e-14);
            const Vec3 c = facet_centroid(facet, mesh.nodes), n = facet_normal(facet, mesh.nodes);
            EXPECT_GT((radius < 3.5 ? -1 : 1) * Vec3(c.x(), 0, c.z()).dot(n), 0);
        }
    EXPECT_LT((mean_normal(mesh, "y_min") + Vec3::UnitY()).norm(), round_off);
    EXPECT_LT((mean_normal(mesh, "y_max") - Vec3::UnitY()).norm(), round_off);
    for (const auto* rim : {"rim_left", "rim_right"}) {
        EXPECT_LT((mean_normal(mesh, rim) - Vec3::UnitZ()).norm(), round_off);
        for (const Facet& facet : mesh.surfaces.at(rim))
            EXPECT_GT(facet_centroid(facet, mesh.nodes).x() * (rim[4] == 'l' ? -1 : 1), 3);
    }
}

TEST(Contactor, HasACylindricalUndersideAndAFlatTop) {
    const Mesh mesh = make_contactor(3, 4, 4, 1, 0.5, {12, 16, 3});
    for (const Facet& facet : mesh.surfaces.at("bottom"))
        for (const Index node : facet) EXPECT_NEAR(std::hypot(mesh.nodes[node].x(), mesh.nodes[node].z()), 3, 1e-14);
    for (const Facet& facet : mesh.surfaces.at("top"))
        for (const Index node : facet) EXPECT_DOUBLE_EQ(mesh.nodes[node].z(), -2);
    const std::map<std::string, Vec3> directions{{"bottom", {0, 0, -1}}, {"top", {0, 0, 1}},   {"rear", {0, -1, 0}},
                                                 {"front", {0, 1, 0}},   {"left", {-1, 0, 0}}, {"right", {1, 0, 0}}};
    for (const auto& [name, direction] : directions)
        EXPECT_LT((mean_normal(mesh, name) - direction).norm(), round_off) << name;
    for (const Facet& facet : mesh.surfaces.at("rear")) EXPECT_DOUBLE_EQ(facet_centroid(facet, mesh.nodes).y(), 0.5);
    for (const Facet& facet : mesh.surfaces.at("front")) EXPECT_DOUBLE_EQ(facet_centroid(facet, mesh.nodes).y(), 4.5);
}

TEST(Generators, RefuseImpossibleArguments) {
    const support::FloatingPointTraps suspended(false); // a comparison with NaN is an invalid operation
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto block = [](Vec3 size, std::array<int, 3> n, CellType element, BlockPattern pattern) {
        return make_block(Vec3::Zero(), size, n, element, pattern);
    };
    EXPECT_THROW(block({1, 1, 1}, {2, 2, 2}, CellType::tet4, BlockPattern::hybrid), std::invalid_argument);
    EXPECT_THROW(block({1, 1, 1}, {2, 2, 2}, CellType::wedge6, BlockPattern::hybrid), std::invalid_argument);
    EXPECT_THROW(block({1, 1, 1}, {2, 2, 2}, CellType::tet10, BlockPattern::hybrid), std::invalid_argument);
    EXPECT_THROW(block({1, 1, 1}, {2, 2, 2}, CellType::tet4, BlockPattern::triangle), std::invalid_argument);
    EXPECT_THROW(block({1, 1, 1}, {0, 2, 2}, CellType::tet10, BlockPattern::quad), std::invalid_argument);
    EXPECT_THROW(block({1, 1, 1}, {std::numeric_limits<int>::max(), 2, 2}, CellType::tet10, BlockPattern::quad),
                 std::invalid_argument);
    EXPECT_THROW(block({1, 1, 1}, {1, 1, 2}, CellType::hex8, BlockPattern::hybrid), std::invalid_argument);
    EXPECT_THROW(block({1, 1, 1}, {2, 0, 2}, CellType::hex8, BlockPattern::quad), std::invalid_argument);
    EXPECT_THROW(block({1, 0, 1}, {2, 2, 2}, CellType::hex8, BlockPattern::quad), std::invalid_argument);
    EXPECT_THROW(block({1, nan, 1}, {2, 2, 2}, CellType::hex8, BlockPattern::quad), std::invalid_argument);
    EXPECT_THROW(block({1, 1, 1}, {10000, 10000, 10000}, CellType::hex8, BlockPattern::quad), std::invalid_argument);
    EXPECT_THROW((void)make_half_tube(3, -1, 12, {4, 4, 4}), std::invalid_argument);
    EXPECT_THROW((void)make_contactor(3, 6.5, 4, 1, 0, {4, 4, 4}), std::invalid_argument);
    EXPECT_THROW((void)make_contactor(3, 4, 4, 0.5, 0, {4, 4, 4}), std::invalid_argument) << "top cuts the underside";
}

TEST(Block, IsOfTheElementsAskedFor) {
    for (const CellType type : generated_types()) {
        const Mesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {2, 2, 2}, type);
        ASSERT_EQ(mesh.blocks.size(), 1u);
        EXPECT_EQ(mesh.blocks[0].type, type);
    }
}

TEST(Place, ScalesRotatesThenTranslates) {
    Mesh mesh = make_block({0, 0, 0}, {1, 2, 3}, {1, 1, 1});
    const double volume = sum_of_cells(mesh);
    place(mesh, {0, 0, 5}, std::numbers::pi / 2, {10, 20, 30}, 2);
    EXPECT_LT((mesh.nodes[1] - Vec3(10, 22, 30)).norm(), 1e-14) << "(1,0,0) turns to (0,1,0), doubles and moves";
    EXPECT_LT((mesh.nodes[7] - Vec3(6, 22, 36)).norm(), 1e-14);
    EXPECT_NEAR(sum_of_cells(mesh), 8 * volume, round_off * 8 * volume);
    EXPECT_THROW(place(mesh, Vec3::Zero(), 1, Vec3::Zero(), 1), std::invalid_argument);
    EXPECT_THROW(place(mesh, Vec3::UnitX(), 1, Vec3::Zero(), -1), std::invalid_argument);
}

TEST(ExteriorFacets, AreInOrderOfBlockElementAndFace) {
    const auto facets =
        exterior_facets(make_block({0, 0, 0}, {1, 1, 1}, {5, 4, 2}, CellType::hex8, BlockPattern::hybrid));
    EXPECT_TRUE(std::is_sorted(facets.begin(), facets.end(), [](const Facet& a, const Facet& b) {
        return std::tie(a.block, a.element) < std::tie(b.block, b.element);
    }));
}

TEST(Facet, HasTheCentroidAreaAndNormalOfItsPositions) {
    const std::vector<Vec3> x{{0, 0, 0}, {2, 0, 0}, {2, 1, 0}, {0, 1, 0}};
    const Facet quad{{0, 1, 2, 3}, 4, -1, -1}, triangle{{0, 1, 2, -1}, 3, -1, -1};
    EXPECT_EQ(facet_centroid(quad, x), Vec3(1, 0.5, 0));
    EXPECT_EQ(facet_area_vector(quad, x), Vec3(0, 0, 2));
    EXPECT_EQ(facet_area_vector(triangle, x), Vec3(0, 0, 1));
    EXPECT_EQ(facet_normal(triangle, x), Vec3(0, 0, 1));
}

} // namespace
} // namespace osculate::mesh::OSCULATE_THIS_FILE
