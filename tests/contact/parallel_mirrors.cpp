/// A strip between parallel symmetry planes stands for a surface without ends.

#include "osculate/contact/mirror.hpp"
#include "osculate/mesh/half_edge_surface.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <map>
#include <utility>
#include <vector>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

constexpr double round_off = 1e-12; ///< of positions below 10, reflected a dozen times

/// Facets (columns x rows) of a plane grid of unit squares, from x = 0 and y = 0.
std::pair<std::vector<mesh::Facet>, std::vector<Vec3>> grid(int columns, int rows) {
    std::vector<Vec3> X;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i) X.emplace_back(i, j, 0);
    std::vector<mesh::Facet> facets;
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const Index o = i + j * (columns + 1);
            mesh::Facet facet;
            facet.count = 4;
            facet.nodes = {o, o + 1, o + columns + 2, o + columns + 1};
            facets.push_back(facet);
        }
    return {facets, X};
}

Vec3 extent(const MirroredSurface& surface, bool high) {
    Vec3 corner = surface.positions.front();
    for (const Vec3& x : surface.positions) corner = high ? Vec3(corner.cwiseMax(x)) : Vec3(corner.cwiseMin(x));
    return corner;
}

TEST(ParallelMirrors, GoOnForSixRingsBeyondBothEndsOfOneRowOfFacets) {
    const auto [facets, X] = grid(8, 1);
    const std::vector<SymmetryPlane> planes{{Vec3(0, 0, 0), Vec3::UnitY()}, {Vec3(0, 1, 0), Vec3::UnitY()}};
    const MirroredSurface surface = mirror(facets, X, planes, 100);
    EXPECT_EQ(surface.facets.size(), 8U * 13);
    EXPECT_NEAR(extent(surface, false).y(), -6, round_off);
    EXPECT_NEAR(extent(surface, true).y(), 7, round_off);
    EXPECT_NEAR(extent(surface, true).x(), 8, round_off) << "nothing beyond a side without a plane";
    EXPECT_EQ(surface.positions.size(), 9U * 14) << "ghosts of neighbouring images are one";
    EXPECT_NO_THROW(mesh::HalfEdgeSurface(surface.facets, surface.positions)) << "oriented alike";
    for (std::size_t i = 0; i < surface.positions.size(); ++i) {
        const Vec3 x = surface.images[surface.image[i]](X[surface.original[i]]);
        EXPECT_LT((x - surface.positions[i]).norm(), round_off);
    }
}

TEST(ParallelMirrors, FillTheCornersOfABox) {
    const auto [facets, X] = grid(1, 2);
    const std::vector<SymmetryPlane> planes{{Vec3(0, 0, 0), Vec3::UnitY()},
                                            {Vec3(0, 2, 0), Vec3::UnitY()},
                                            {Vec3(0, 0, 0), Vec3::UnitX()},
                                            {Vec3(1, 0, 0), Vec3::UnitX()}};
    const MirroredSurface surface = mirror(facets, X, planes, 100);
    EXPECT_EQ(surface.facets.size(), 13U * 14);
    std::map<std::pair<long, long>, int> at;
    for (const mesh::Facet& facet : surface.facets) {
        Vec3 centre = Vec3::Zero();
        for (const Index node : facet) centre += surface.positions[node] / 4;
        ++at[{std::lround(2 * centre.x()), std::lround(2 * centre.y())}];
    }
    EXPECT_EQ(at.size(), surface.facets.size()) << "no place twice";
    EXPECT_NO_THROW(mesh::HalfEdgeSurface(surface.facets, surface.positions));
}

TEST(ParallelMirrors, ReachNoFartherThanTheDepth) {
    const auto [facets, X] = grid(3, 1);
    const std::vector<SymmetryPlane> planes{{Vec3(0, 0, 0), Vec3::UnitY()}};
    EXPECT_EQ(mirror(facets, X, planes, 0.5).facets.size(), 6U);
    EXPECT_EQ(mirror(facets, X, {}, 0.5).facets.size(), 3U);
}

TEST(ParallelMirrors, LeaveFacetsAloneThatLieInAPlane) {
    const auto [facets, X] = grid(3, 2);
    const std::vector<SymmetryPlane> planes{{Vec3(0, 0, 0), Vec3::UnitZ()}, {Vec3(0, 0, 0), Vec3::UnitY()}};
    EXPECT_EQ(mirror(facets, X, {planes[0]}, 100).facets.size(), 6U);
    const MirroredSurface both = mirror(facets, X, planes, 100);
    EXPECT_NO_THROW(mesh::HalfEdgeSurface(both.facets, both.positions)) << "no facet twice";
}

/// Planes at 60 degrees: six images around their common line.
TEST(ParallelMirrors, FillTheTurnAroundAnEdgeBetweenTwoPlanes) {
    const std::vector<Vec3> X{{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}};
    mesh::Facet facet;
    facet.count = 3;
    facet.nodes = {0, 1, 2, -1};
    const std::vector<SymmetryPlane> planes{{Vec3::Zero(), Vec3::UnitY()},
                                            {Vec3::Zero(), Vec3(std::sqrt(0.75), -0.5, 0)}};
    const MirroredSurface surface = mirror({facet}, X, planes, 100);
    EXPECT_EQ(surface.facets.size(), 6U);
    EXPECT_EQ(surface.positions.size(), 7U);
    EXPECT_NO_THROW(mesh::HalfEdgeSurface(surface.facets, surface.positions));
}

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
