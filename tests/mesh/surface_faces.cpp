#include "osculate/mesh/surface_faces.hpp"

#include "osculate/core/error.hpp"
#include "osculate/mesh/generators.hpp"
#include "osculate/mesh/select.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <gmock/gmock.h>
#include <set>

namespace osculate::mesh::OSCULATE_THIS_FILE {
namespace {

TEST(SurfaceFaces, PutTheQuartersOfATet10sFacesTogetherInAnyOrder) {
    const Mesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {2, 3, 2}, CellType::tet10);
    std::vector<Facet> facets = exterior_facets(mesh);
    std::stable_sort(facets.begin(), facets.end(), // far from one another
                     [](const Facet& a, const Facet& b) { return a.nodes[2] % 7 < b.nodes[2] % 7; });
    const std::vector<SurfaceFace> faces = surface_faces(mesh, facets);
    EXPECT_EQ(faces.size(), facets.size() / 4);
    std::set<Index> corners, middles;
    for (const SurfaceFace& face : faces) {
        ASSERT_EQ(face.count, 6);
        EXPECT_TRUE(face.whole());
        for (std::size_t i = 0; i < 3; ++i) {
            const Vec3 middle = (mesh.nodes[face.nodes[i]] + mesh.nodes[face.nodes[(i + 1) % 3]]) / 2;
            EXPECT_LT((mesh.nodes[face.nodes[3 + i]] - middle).norm(), 1e-15) << "edges 01, 12, 20";
            corners.insert(face.nodes[i]);
            middles.insert(face.nodes[3 + i]);
        }
        const Vec3 &a = mesh.nodes[face.nodes[0]], &b = mesh.nodes[face.nodes[1]], &c = mesh.nodes[face.nodes[2]];
        EXPECT_GT((b - a).cross(c - a).dot((a + b + c) / 3 - Vec3::Constant(0.5)), 0) << "outward";
    }
    EXPECT_EQ(corners.size(), 3u * 4 * 3 - 2) << "those of the hexahedra, two of them inside";
    for (const Index node : corners) EXPECT_FALSE(middles.contains(node));
}

TEST(SurfaceFaces, KnowWhichQuartersASurfaceHas) {
    const Mesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {1, 1, 1}, CellType::tet10);
    const auto exterior = exterior_facets(mesh);
    const Region half = select_box(mesh, exterior, {0, 0, 1}, {0.5, 1, 1});
    ASSERT_EQ(half.facets.size(), 4u) << "of the eight on top, with two triangles";
    const auto faces = surface_faces(mesh, half.facets);
    ASSERT_EQ(faces.size(), 2u);
    for (const SurfaceFace& face : faces) {
        EXPECT_FALSE(face.whole());
        for (std::size_t q = 0; q < 3;
             ++q) // the quarter at a corner where this and the middles next to it are left of the cut
            EXPECT_EQ(face.pieces[q],
                      std::ranges::all_of(std::array<std::size_t, 3>{q, 3 + q, 3 + (q + 2) % 3},
                                          [&](std::size_t i) { return mesh.nodes[face.nodes[i]].x() <= 0.5; }));
    }
}

TEST(SurfaceFaces, OfOtherElementsAreTheirFacets) {
    const Mesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {1, 1, 1});
    std::vector<Facet> facets = mesh.surfaces.at("x_max");
    const auto own = surface_faces(mesh, facets);
    ASSERT_EQ(own.size(), 1u);
    EXPECT_EQ(own[0].count, 4);
    EXPECT_TRUE(std::equal(own[0].begin(), own[0].end(), facets[0].begin(), facets[0].end()));
}

TEST(SurfaceFaces, KeepTheNumbersOfTheirFacets) {
    const Mesh mesh = make_block({0, 0, 0}, {1, 1, 1}, {1, 1, 1}, CellType::tet10);
    std::vector<Facet> facets = mesh.surfaces.at("z_max");
    const auto own = surface_faces(mesh, facets);
    for (Facet& facet : facets)
        for (int c = 0; c < 3; ++c) facet.nodes[c] += 100;
    const auto shifted = surface_faces(mesh, facets, 100);
    ASSERT_EQ(shifted.size(), own.size());
    for (std::size_t f = 0; f < own.size(); ++f)
        for (std::size_t i = 0; i < 6; ++i) EXPECT_EQ(shifted[f].nodes[i], own[f].nodes[i] + 100);
    EXPECT_THROW((void)surface_faces(mesh, facets), InternalError) << "facets that are none of the element's";
}

} // namespace
} // namespace osculate::mesh::OSCULATE_THIS_FILE
