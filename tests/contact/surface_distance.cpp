/// Distances of points and facets from a surface against brute force.

#include "osculate/contact/surface_distance.hpp"

#include "contact/surfaces.hpp"
#include "support/random.hpp"

#include <array>
#include <cmath>
#include <gtest/gtest.h>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

using osculate::support::Random;

constexpr double round_off = 1e-12;

/// Top of a block, [0, 5] x [0, 4], 0.5 m, bent up.
class BentTop : public ::testing::TestWithParam<mesh::BlockPattern> {
protected:
    BentTop() {
        for (Vec3& p : surface.x) p.z() = 0.05 * p.x() * p.x();
    }
    fixtures::Surface surface = fixtures::block_top(GetParam());
};

TEST_P(BentTop, FindsTheClosestFacetOfAll) {
    const SurfaceDistance distance(surface.topology, surface.x);
    Random random(1);
    for (int k = 0; k < 200; ++k) {
        const Vec3 p(random.uniform(-1, 6), random.uniform(-1, 5), random.uniform(-1, 2));
        double least = std::numeric_limits<double>::infinity();
        for (Index f = 0; f < surface.topology.facet_count(); ++f) least = std::min(least, distance.from(f, p));
        const NearFacet near = distance.closest(p);
        EXPECT_EQ(near.distance, least);
        EXPECT_EQ(distance.from(near.facet, p), least);
    }
}

TEST_P(BentTop, TellsWhereItEnds) {
    const SurfaceDistance distance(surface.topology, surface.x);
    EXPECT_FALSE(distance.closest({2.6, 2.2, 0.5}).at_end);
    EXPECT_TRUE(distance.closest({2.6, 4.2, 0.5}).at_end);
    EXPECT_TRUE(distance.closest({-0.1, -0.1, 0}).at_end);
}

TEST_P(BentTop, IsAsFarFromAFacetAsItsPointsAre) {
    const SurfaceDistance distance(surface.topology, surface.x);
    Random random(2);
    for (int k = 0; k < 60; ++k) {
        std::array<Vec3, 3> corner;
        for (Vec3& p : corner) p = Vec3(random.uniform(-1, 6), random.uniform(-1, 5), random.uniform(-0.5, 2));
        double sampled = std::numeric_limits<double>::infinity(), longest = 0;
        constexpr int n = 40;
        for (int i = 0; i <= n; ++i)
            for (int j = 0; i + j <= n; ++j)
                sampled = std::min(
                    sampled,
                    distance.closest(corner[0] + (corner[1] - corner[0]) * i / n + (corner[2] - corner[0]) * j / n)
                        .distance);
        for (int c = 0; c < 3; ++c) longest = std::max(longest, (corner[(c + 1) % 3] - corner[c]).norm());
        const double got = distance.from(corner, 100);
        EXPECT_LE(got, sampled + round_off);
        EXPECT_GE(got, sampled - longest / n) << "no sample is farther from any point than that";
    }
}

TEST_P(BentTop, CountsNoFacetThatDoesNot) {
    const SurfaceDistance distance(surface.topology, surface.x);
    const Vec3 p(2.6, 2.2, 0.5);
    const Index first = distance.closest(p).facet;
    const NearFacet next = distance.closest(p, [&](Index f) { return f != first; });
    EXPECT_NE(next.facet, first);
    EXPECT_GT(next.distance, distance.from(first, p));
    EXPECT_EQ(distance.closest(p, [](Index) { return false; }).facet, -1);
}

TEST(SegmentDistance, IsThatOfTheCommonPerpendicularOrOfTheEnds) {
    EXPECT_NEAR(segment_distance({-1, 0, 0}, {1, 0, 0}, {0, -1, 0.3}, {0, 1, 0.3}), 0.3, round_off);
    EXPECT_NEAR(segment_distance({-1, 0, 0}, {1, 0, 0}, {0, 3, 4}, {0, 9, 4}), 5, round_off);
    EXPECT_NEAR(segment_distance({-1, 0, 0}, {1, 0, 0}, {2, 0, 1}, {5, 0, 1}), std::sqrt(2), round_off) << "parallel";
    EXPECT_NEAR(segment_distance({-1, 0, 0}, {1, 0, 0}, {0, 0.2, 0}, {0, 0.2, 0}), 0.2, round_off) << "a point";
}

INSTANTIATE_TEST_SUITE_P(Meshes, BentTop, ::testing::Values(mesh::BlockPattern::quad, mesh::BlockPattern::hybrid));

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
