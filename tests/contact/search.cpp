#include "osculate/contact/search.hpp"

#include "blend_surfaces.hpp"
#include "osculate/contact/facet_patch.hpp"

#include <gtest/gtest.h>
#include <limits>
#include <numbers>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

using namespace fixtures;
using osculate::support::Random;

constexpr double round_off = 1e-12; // of coordinates of order ten

/// Queries against brute force, a surface: a tenth of a million in all, with OSCULATE_FULL=1 a million.
const int scale = full() ? 10 : 1;
const int standing = 10'000 * scale, moving = 5'000 * scale, followed = 5'000 * scale;

/// Closest distance to a triangle, by its plane, its edges and its corners.
double distance_to_triangle(const Vec3& s, const Vec3& a, const Vec3& b, const Vec3& c) {
    const Vec3 n = (b - a).cross(c - a).normalized();
    const Vec3 corners[3] = {a, b, c};
    bool inside = true;
    double nearest = std::numeric_limits<double>::max();
    for (int k = 0; k < 3; ++k) {
        const Vec3 from = corners[k], edge = corners[(k + 1) % 3] - from;
        inside = inside && n.dot(edge.cross(s - from)) >= 0;
        const double t = std::clamp(edge.dot(s - from) / edge.squaredNorm(), 0.0, 1.0);
        nearest = std::min(nearest, (s - from - t * edge).norm());
    }
    return inside ? std::abs(n.dot(s - a)) : nearest;
}

/// Closest distance to a surface of plane facets, by looking at every one.
double brute_force(const Surface& surface, const Vec3& s) {
    double nearest = std::numeric_limits<double>::max();
    for (Index f = 0; f < surface.topology.facet_count(); ++f) {
        const auto v = surface.topology.facet_vertices(f);
        for (std::size_t k = 1; k + 1 < v.size(); ++k)
            nearest = std::min(nearest, distance_to_triangle(s, surface.x[v[0]], surface.x[v[k]], surface.x[v[k + 1]]));
    }
    return nearest;
}

/// The point that a hit names on its facet.
Vec3 point_of(const Surface& surface, const FacetHit& hit) {
    const auto vertices = surface.topology.facet_vertices(hit.facet);
    MatrixX3 corners(static_cast<Index>(vertices.size()), 3);
    for (Index b = 0; b < corners.rows(); ++b) corners.row(b) = surface.x[vertices[b]].transpose();
    return FacetPatch(static_cast<int>(vertices.size())).point(hit.u, corners).X;
}

class Search : public ::testing::TestWithParam<int> {
protected:
    const Surface surface = std::move(all_surfaces()[GetParam()]);
    FacetSearch search{surface.topology};

    void SetUp() override { search.build(surface.x); }
};

TEST_P(Search, FindsTheClosestFacetOfAll) {
    Random random(21);
    for (int i = 0; i < standing; ++i) {
        const Vec3 s = random_point(surface, 1.5, random);
        const FacetHit hit = search.global(s, surface.x);
        ASSERT_NEAR(hit.distance, brute_force(surface, s), round_off) << s.transpose();
        ASSERT_NEAR((s - point_of(surface, hit)).norm(), hit.distance, round_off) << s.transpose();
    }
}

/// Somewhere within 0.3 of the surface: a and b in [0, 1] run over it, c in [-1, 1] off it.
Vec3 near_surface(const Surface& surface, double a, double b, double c) {
    if (surface.name.starts_with("HalfTube")) {
        const double angle = std::numbers::pi * (1 + a), radius = tube_radius + 0.3 * c;
        return {radius * std::cos(angle), tube_length * b, radius * std::sin(angle)};
    }
    return {5 * a, 4 * b, 0.3 * c};
}

TEST_P(Search, FollowsAPointToTheClosestFacet) {
    Random random(22);
    for (int path = 0; path < 10; ++path) {
        double a = random.uniform(0, 1), b = random.uniform(0, 1);
        Index facet = search.global(near_surface(surface, a, b, 0), surface.x).facet;
        for (int i = 0; i < 300; ++i) {
            a = std::clamp(a + 0.06 * random.uniform(), -0.02, 1.02); // up to a facet a step, and past the boundary
            b = std::clamp(b + 0.06 * random.uniform(), -0.02, 1.02);
            const Vec3 s = near_surface(surface, a, b, random.uniform());
            const FacetHit hit = search.track(s, facet, surface.x, 0);
            ASSERT_NEAR(hit.distance, brute_force(surface, s), round_off) << s.transpose() << " from facet " << facet;
            facet = hit.facet;
        }
    }
}

/// A surface between queries: it turns, is strained and dented anew each time it is asked to move.
class MovingSearch : public Search {
protected:
    Surface moved = surface;

    /// Rotation, shift and a strain up to 20 %: facets stay plane.
    void carry(Random& random) {
        const Mat3 turn = Eigen::AngleAxisd(pi * random.uniform(), random.direction()).toRotationMatrix();
        Mat3 strain = Mat3::Identity();
        for (int k = 0; k < 3; ++k) strain.col(k) += random.vector(0.1);
        const Vec3 shift = random.vector(3);
        for (std::size_t v = 0; v < moved.x.size(); ++v) moved.x[v] = turn * (strain * surface.x[v]) + shift;
    }
    /// Every node on its own: quadrilaterals warp.
    void dent(Random& random) {
        const double amount = 0.1 * surface.topology.mean_facet_size();
        for (Vec3& x : moved.x) x += random.vector(amount);
    }
    /// Closest distance of all facets, warped or not, by looking at every one; closest_on() has its own oracle.
    [[nodiscard]] double brute_force_warped(const Vec3& s) const {
        double nearest = std::numeric_limits<double>::max();
        for (Index f = 0; f < moved.topology.facet_count(); ++f)
            nearest = std::min(nearest, search.closest_on(f, s, moved.x).distance);
        return nearest;
    }
};

TEST_P(MovingSearch, FindsTheClosestFacetOfAllWhereverTheSurfaceIs) {
    constexpr int queries = 50; // a motion
    Random random(25);
    for (int motion = 0; motion < moving / queries; ++motion) {
        carry(random);
        const bool warped = motion % 2 == 1;
        if (warped) dent(random);
        search.build(moved.x);
        for (int i = 0; i < queries; ++i) {
            const Vec3 s = random_point(moved, 1, random);
            const FacetHit hit = search.global(s, moved.x);
            ASSERT_NEAR(hit.distance, warped ? brute_force_warped(s) : brute_force(moved, s), round_off)
                << s.transpose() << " after motion " << motion;
        }
    }
}

/// As in a run: points close to a surface that moves and dents a little from query to query, each followed from the facet
/// it was on. No tree is built.
TEST_P(MovingSearch, FollowsPointsFromTheirLastFacet) {
    constexpr int points = 50;
    Random random(26);
    std::vector<std::pair<double, double>> place(points);
    std::vector<Index> facet(points);
    for (int k = 0; k < points; ++k) {
        place[k] = {random.uniform(0, 1), random.uniform(0, 1)};
        facet[k] = search.global(near_surface(surface, place[k].first, place[k].second, 0), surface.x).facet;
    }
    const double size = surface.topology.mean_facet_size();
    const std::vector<Vec3>& X = surface.x;
    Mat3 turn = Mat3::Identity();
    Vec3 shift = Vec3::Zero();
    for (int i = 0; i < followed / points; ++i) {
        turn = Eigen::AngleAxisd(0.02 * random.uniform(), random.direction()).toRotationMatrix() * turn;
        shift += random.vector(0.1 * size);
        for (std::size_t v = 0; v < X.size(); ++v) moved.x[v] = turn * (X[v] + random.vector(0.05 * size)) + shift;
        for (int k = 0; k < points; ++k) {
            auto& [a, b] = place[k];
            a = std::clamp(a + 0.06 * random.uniform(), -0.02, 1.02);
            b = std::clamp(b + 0.06 * random.uniform(), -0.02, 1.02);
            const Vec3 s = turn * near_surface(surface, a, b, random.uniform()) + shift;
            const FacetHit hit = search.track(s, facet[k], moved.x, 0);
            ASSERT_NEAR(hit.distance, brute_force_warped(s), round_off) << s.transpose() << " from facet " << facet[k];
            facet[k] = hit.facet;
        }
    }
}

TEST_P(Search, FollowsALeapAcrossTheSurface) {
    const Vec3 start = near_surface(surface, 0.1, 0.1, 0.2), end = near_surface(surface, 0.9, 0.8, 0.2);
    const Index facet = search.global(start, surface.x).facet;
    EXPECT_NEAR(search.track(end, facet, surface.x, 0).distance, brute_force(surface, end), round_off);
}

INSTANTIATE_TEST_SUITE_P(On, Search, ::testing::Range(0, 5),
                         [](const auto& tested) { return all_surfaces()[tested.param].name; });

INSTANTIATE_TEST_SUITE_P(On, MovingSearch, ::testing::Range(0, 5),
                         [](const auto& tested) { return all_surfaces()[tested.param].name; });

TEST(FacetSearch, TakesTheLowestFacetAmongEquals) {
    const Surface surface = block_top(mesh::BlockPattern::quad);
    FacetSearch search(surface.topology);
    search.build(surface.x);
    int inner = 0;
    for (Index v = 0; v < surface.topology.vertex_count(); ++v) {
        if (surface.topology.is_boundary_vertex(v)) continue;
        const auto around = surface.topology.vertex_facets(v);
        const Vec3 s = surface.x[v] + Vec3(0, 0, 0.5); // spacing and height are exact in binary: distances are equal
        EXPECT_EQ(search.global(s, surface.x).facet, *std::min_element(around.begin(), around.end()));
        ++inner;
    }
    EXPECT_EQ(inner, 9 * 7);
}

/// The rule of the second constructor: nearest to a point of reference, not first in the numbering.
TEST(FacetSearch, BreaksTiesByGeometryWhateverTheNumbering) {
    const Surface surface = block_top(mesh::BlockPattern::quad);
    const Vec3 about(1.1, 1.7, 0); // no vertex of the grid has two facets at one distance from here
    FacetSearch search(surface.topology, surface.x, about);
    search.build(surface.x);
    Random random(24);
    for (Index v = 0; v < surface.topology.vertex_count(); ++v) {
        if (surface.topology.is_boundary_vertex(v)) continue;
        const Vec3 s = surface.x[v] + Vec3(0, 0, 0.3) + random.vector(1e-9); // round-off must not decide
        Index nearest = -1;
        double distance = std::numeric_limits<double>::max();
        for (const Index f : surface.topology.vertex_facets(v)) {
            Vec3 centre = Vec3::Zero();
            for (const Index corner : surface.topology.facet_vertices(f)) centre += surface.x[corner] / 4;
            if ((centre - about).norm() < distance) {
                distance = (centre - about).norm();
                nearest = f;
            }
        }
        EXPECT_EQ(search.global(s, surface.x).facet, nearest);
        const auto around = surface.topology.vertex_facets(v);
        // some of them are closer by 1e-10, far less than what counts
        const Vec3 beside = surface.x[v] + Vec3(0, 0, 0.3) + random.vector(1e-5);
        for (const Index from : surface.topology.ring_facets(nearest, 2)) // one that the point is over keeps it
            if (std::ranges::count(around, from) == 0) {
                EXPECT_EQ(search.track(beside, from, surface.x, 0).facet, nearest) << "from " << from;
            }
    }
}

TEST(FacetSearch, FindsNothingBeforeItIsBuilt) {
    const Surface surface = half_tube();
    EXPECT_EQ(FacetSearch(surface.topology).global(Vec3::Zero(), surface.x).facet, -1);
}

TEST(FacetSearch, FollowsTheSurfaceWhereverItMoves) {
    Surface surface = half_tube();
    FacetSearch search(surface.topology);
    search.build(surface.x);
    const Vec3 s(0.5, 6.1, -2.5), shift(100, -50, 20);
    const FacetHit before = search.global(s, surface.x);
    for (Vec3& x : surface.x) x += shift;
    search.build(surface.x);
    const FacetHit after = search.global(s + shift, surface.x);
    EXPECT_EQ(after.facet, before.facet);
    EXPECT_NEAR(after.distance, before.distance, 10 * round_off); // coordinates of order a hundred now
}

TEST(FacetSearch, FindsTheClosestPointOfAWarpedQuadrilateral) {
    Random random(23);
    for (int warp = 0; warp < 40; ++warp) {
        Surface surface = block_top(mesh::BlockPattern::quad);
        for (Vec3& x : surface.x) x += random.vector(0.08); // of facets of size 0.5
        const FacetSearch search(surface.topology);
        const Index facet = 37;
        for (int i = 0; i < 10; ++i) {
            const Vec3 s = surface.x[surface.topology.facet_vertices(facet)[0]] + random.vector(0.7);
            const FacetHit hit = search.closest_on(facet, s, surface.x);
            EXPECT_NEAR((s - point_of(surface, hit)).norm(), hit.distance, round_off);
            const int samples = 40;
            double nearest = std::numeric_limits<double>::max();
            FacetHit sample{.facet = facet};
            for (int a = 0; a <= samples; ++a)
                for (int b = 0; b <= samples; ++b) {
                    sample.u = Vec2(2.0 * a / samples - 1, 2.0 * b / samples - 1);
                    nearest = std::min(nearest, (s - point_of(surface, sample)).norm());
                }
            EXPECT_LE(hit.distance, nearest + round_off);
        }
    }
}

/// The flat top with facets of size 0.5, and a point over facet `from` that moves past the edge x = 1.5.
TEST(FacetSearch, KeepsTheFacetUntilThePointHasLeftItByTheMargin) {
    const Surface surface = block_top(mesh::BlockPattern::quad);
    FacetSearch search(surface.topology);
    search.build(surface.x);
    const double hysteresis = 0.1, margin = hysteresis * 0.5, edge = 1.5;
    const auto at = [](double x) { return Vec3(x, 1.3, 0.02); };
    const Index left = search.global(at(edge - 0.25), surface.x).facet;
    const Index right = search.global(at(edge + 0.25), surface.x).facet;
    ASSERT_NE(left, right);
    EXPECT_EQ(search.track(at(edge + 0.9 * margin), left, surface.x, hysteresis).facet, left);
    EXPECT_EQ(search.track(at(edge + 1.1 * margin), left, surface.x, hysteresis).facet, right);
    EXPECT_EQ(search.track(at(edge - 0.9 * margin), right, surface.x, hysteresis).facet, right);
    EXPECT_EQ(search.track(at(edge - 1.1 * margin), right, surface.x, hysteresis).facet, left);
    EXPECT_EQ(search.track(at(edge + 0.1 * margin), left, surface.x, 0).facet, right) << "no hysteresis asked for";
}

/// In the fold between two facets of a coarse tube a point is over both of them; the nearer wins by the margin only.
TEST(FacetSearch, KeepsTheFacetUntilAnotherIsCloserByTheMargin) {
    const Surface surface = half_tube(mesh::CellType::hex8, 4); // 45 degrees from facet to facet
    FacetSearch search(surface.topology);
    search.build(surface.x);
    const Vec3 edge(0, 6.2, -tube_radius);
    const double a = std::numbers::pi / 8; // slopes of the two facets beside the lowest edge
    const Vec3 left_n(std::sin(a), 0, std::cos(a)), left_t(-std::cos(a), 0, std::sin(a));
    const Index left = search.global(edge + left_t, surface.x).facet;
    const Index right = search.global(edge - Vec3(left_t.x(), 0, -left_t.z()), surface.x).facet;
    ASSERT_NE(left, right);
    const double angle = 80 * std::numbers::pi / 180, r = 0.1; // from the left facet; the right one is 55 degrees away
    const Vec3 s = edge + r * (std::cos(angle) * left_t + std::sin(angle) * left_n);
    const double difference = r * (std::sin(angle) - std::sin(135 * std::numbers::pi / 180 - angle));
    const double size = surface.topology.facet_size(left);
    EXPECT_EQ(search.closest_on(left, s, surface.x).overhang, 0);
    EXPECT_EQ(search.track(s, left, surface.x, 1.1 * difference / size).facet, left);
    EXPECT_EQ(search.track(s, left, surface.x, 0.9 * difference / size).facet, right);
}

/// Behind a hollow surface the points between two facets are nearest to their common edge, and beyond both facets.
TEST(FacetSearch, TellsTheFoldAtTheEndOfASurfaceFromBeyondIt) {
    const Surface surface = half_tube();
    FacetSearch search(surface.topology);
    search.build(surface.x);
    const Vec3 in_the_fold(0, 0, -tube_radius - 0.3), past_the_end(0, -0.1, -tube_radius - 0.3);
    const FacetHit inside = search.global(in_the_fold, surface.x), outside = search.global(past_the_end, surface.x);
    EXPECT_TRUE(inside.boundary);
    EXPECT_GT(inside.overhang, 0.03);
    EXPECT_NEAR(inside.beyond, 0, round_off);
    EXPECT_NEAR(outside.beyond, 0.1, round_off);
}

class Flags : public ::testing::TestWithParam<mesh::BlockPattern> {
protected:
    const Surface surface = block_top(GetParam());
    FacetSearch search{surface.topology};

    void SetUp() override { search.build(surface.x); }
};

TEST_P(Flags, SayThatAnInnerPointHasNoOverhang) {
    const FacetHit hit = search.global({2.2, 2.1, 0.3}, surface.x);
    EXPECT_NEAR(hit.distance, 0.3, round_off);
    EXPECT_EQ(hit.overhang, 0);
    EXPECT_FALSE(hit.boundary);
    EXPECT_EQ(hit.beyond, 0);
}

TEST_P(Flags, MeasureTheOverhangPastAnEdgeOfTheSurface) {
    const FacetHit hit = search.global({5.3, 2.1, 0.4}, surface.x);
    EXPECT_NEAR(hit.distance, 0.5, round_off); // 0.3, 0.4, 0.5
    EXPECT_NEAR(hit.overhang, 0.3, round_off);
    EXPECT_TRUE(hit.boundary);
    EXPECT_NEAR(hit.beyond, 0.3, round_off);
}

TEST_P(Flags, MeasureTheOverhangPastACornerOfTheSurface) {
    const FacetHit hit = search.global({5.3, 4.4, -0.2}, surface.x);
    EXPECT_NEAR(hit.overhang, 0.5, round_off);
    EXPECT_TRUE(hit.boundary);
    EXPECT_NEAR(hit.beyond, 0.4, round_off) << "the farther of the two edges";
}

TEST_P(Flags, KnowAnInnerEdgeFromABoundary) {
    int inner_edges = 0, boundary_edges = 0;
    for (Index f = 0; f < surface.topology.facet_count(); ++f) {
        const auto v = surface.topology.facet_vertices(f);
        Vec3 centre = Vec3::Zero();
        for (const Index i : v) centre += surface.x[i] / static_cast<double>(v.size());
        for (std::size_t c = 0; c < v.size(); ++c) {
            const Vec3 edge = surface.x[v[(c + 1) % v.size()]] - surface.x[v[c]];
            const Vec3 middle = surface.x[v[c]] + 0.5 * edge, out = edge.cross(Vec3::UnitZ()).normalized();
            const FacetHit hit = search.closest_on(f, middle + 0.1 * out, surface.x);
            const bool boundary = surface.topology.is_boundary_edge(surface.topology.first_half_edge(f) + Index(c));
            EXPECT_NEAR(hit.overhang, 0.1, round_off);
            EXPECT_EQ(hit.boundary, boundary);
            EXPECT_NEAR(hit.beyond, boundary ? 0.1 : 0, round_off);
            ++(boundary ? boundary_edges : inner_edges);

            const FacetHit corner = search.closest_on(f, surface.x[v[c]] + 0.1 * (surface.x[v[c]] - centre), surface.x);
            EXPECT_EQ(corner.boundary, surface.topology.is_boundary_vertex(v[c]));
        }
    }
    EXPECT_EQ(boundary_edges, 2 * (10 + 8));
    EXPECT_GT(inner_edges, boundary_edges);
}

INSTANTIATE_TEST_SUITE_P(On, Flags,
                         ::testing::Values(mesh::BlockPattern::quad, mesh::BlockPattern::triangle,
                                           mesh::BlockPattern::hybrid),
                         [](const auto& tested) { return block_top(tested.param).name; });

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
