/// Paths of points through moving facets, against cases with known answers.

#include "osculate/contact/path_crossing.hpp"

#include "support/random.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

using Corners = MovingFacets::Corners;

/// Faces of a box, outward, as quadrilaterals.
struct Box {
    std::vector<Vec3> x;
    std::vector<Corners> facets{{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}};
    static constexpr Index top = 1;

    explicit Box(const Vec3& size) {
        for (const double z : {0.0, size.z()})
            for (const auto& [u, v] : {std::pair{0.0, 0.0}, {1.0, 0.0}, {1.0, 1.0}, {0.0, 1.0}})
                x.emplace_back(u * size.x(), v * size.y(), z);
    }
    [[nodiscard]] std::vector<Vec3> moved(const Vec3& by) const {
        std::vector<Vec3> result = x;
        for (Vec3& v : result) v += by;
        return result;
    }
    [[nodiscard]] MovingFacets moving(const Vec3& by) const { return {facets, x, moved(by)}; }
};

constexpr double round_off = 1e-12; // of lengths around 1
const auto none_allowed = [](Index) { return 0.0; };

TEST(PathCrossing, FindsWhereAPathGoesThroughAPlateAndComesOut) {
    const MovingFacets plate = Box({1, 1, 0.01}).moving(Vec3::Zero());
    const auto met = plate.crossings({0.3, 0.4, 1.01}, {0.3, 0.4, -1});
    ASSERT_EQ(met.size(), 2u);
    EXPECT_TRUE(met[0].inward);
    EXPECT_EQ(met[0].facet, Box::top);
    EXPECT_NEAR(met[0].time, 1 / 2.01, round_off);
    EXPECT_NEAR(met[0].before, 1, round_off);
    EXPECT_NEAR(met[0].after, -1.01, round_off);
    EXPECT_FALSE(met[1].inward);
    EXPECT_NEAR(met[1].time, 1.01 / 2.01, round_off);
    const auto passage = plate.first_passage({0.3, 0.4, 1.01}, {0.3, 0.4, -1}, none_allowed);
    ASSERT_TRUE(passage);
    EXPECT_TRUE(passage->left);
}

TEST(PathCrossing, SeesRelativeMotionOnly) {
    const Vec3 far(1e3, -2e3, 5e2), s0(0.3, 0.4, 1.01);
    const Box box({1, 1, 0.01});
    EXPECT_TRUE(box.moving(far).crossings(s0, s0 + far).empty()) << "both fly together";
    const auto met = box.moving({0, 0, 2}).crossings(s0, s0);
    ASSERT_EQ(met.size(), 2u) << "the plate flies over the point";
    EXPECT_NEAR(met[0].time, 0.5, round_off);
}

TEST(PathCrossing, LeavesAPathAloneThatPassesBy) {
    const MovingFacets plate = Box({1, 1, 0.01}).moving(Vec3::Zero());
    for (const double beside : {1e-6, 0.1}) // of the plate
        EXPECT_FALSE(plate.first_passage({0.9, 0.5, 0.1 + 0.01}, {1.1 + 2 * beside, 0.5, -0.1 + 0.01}, none_allowed))
            << beside;
    EXPECT_TRUE(plate.first_passage({0.9, 0.5, 0.1 + 0.01}, {1.1 - 2e-6, 0.5, -0.1 + 0.01}, none_allowed));
    EXPECT_FALSE(plate.first_passage({0.5, 0.5, 0.005}, {0.5, 0.5, 1}, none_allowed)) << "from inside out";
    EXPECT_FALSE(plate.first_passage({0.5, 0.5, 0.2}, {0.9, 0.1, 0.0101}, none_allowed)) << "stops before";
}

TEST(PathCrossing, CallsATouchOfAnEdgeFromOutsideInAndOut) {
    const Vec3 size(1, 1, 0.01);
    for (const double y : {0.2, 0.5, 0.7}) // both orders of the facets: over the top, and from beside
        for (const double way : {1.0, -1.0}) {
            const Vec3 edge(1, y, 0.01), along(0.1 * way, 0, -0.1 * way);
            const auto met = Box(size).moving(Vec3::Zero()).crossings(edge - along, edge + along);
            ASSERT_EQ(met.size(), 2u) << y;
            EXPECT_TRUE(met[0].inward) << y;
            EXPECT_FALSE(met[1].inward) << y;
        }
}

TEST(PathCrossing, DoesNotCrossTheFacetThatAPointStartsOn) {
    const MovingFacets plate = Box({1, 1, 0.01}).moving(Vec3::Zero());
    EXPECT_TRUE(plate.crossings({0.3, 0.4, 0.01}, {0.3, 0.4, 1}).empty()) << "outward";
    const auto met = plate.crossings({0.3, 0.4, 0.01}, {0.3, 0.4, -1});
    ASSERT_EQ(met.size(), 1u) << "inward: the other side alone";
    EXPECT_FALSE(met[0].inward);
}

TEST(PathCrossing, FindsTheExactTimeWithAFacetThatTurns) {
    // z = (1 - 2 t) x for the facet and z = 0.1 for the point at x = 0.5: met at t = 0.4
    const std::vector<Corners> facet{{0, 1, 2, -1}};
    const std::vector<Vec3> x0{{0, -1, 0}, {2, -1, 2}, {0, 2, 0}}, x1{{0, -1, 0}, {2, -1, -2}, {0, 2, 0}};
    const auto met = MovingFacets(facet, x0, x1).crossings({0.5, 0, 0.1}, {0.5, 0, 0.1});
    ASSERT_EQ(met.size(), 1u);
    EXPECT_NEAR(met[0].time, 0.4, round_off);
    EXPECT_FALSE(met[0].inward);
    EXPECT_NEAR(met[0].normal.dot(Vec3(-0.2, 0, 1).normalized()), 1, round_off);
}

/// A facet that turns by more than half a turn meets a point at rest up to three times; bisection of the signed volume over
/// many small pieces of the step says when.
TEST(PathCrossing, AgreesWithManySmallPiecesOfTheStep) {
    osculate::support::Random random(7);
    int crossings = 0, disagree = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        std::vector<Vec3> x0, x1;
        for (int i = 0; i < 3; ++i) {
            x0.push_back(random.vector());
            x1.push_back(random.vector());
        }
        const Vec3 s0 = 0.3 * random.vector(), s1 = 0.3 * random.vector();
        const MovingFacets facet({{0, 1, 2, -1}}, x0, x1);
        const auto inside = [&](double t, double& volume) {
            const auto at = [&](const Vec3& a, const Vec3& b) -> Vec3 { return a + t * (b - a); };
            const Vec3 s = at(s0, s1), a = at(x0[0], x1[0]), b = at(x0[1], x1[1]), c = at(x0[2], x1[2]);
            const Vec3 n = (b - a).cross(c - a);
            volume = n.dot(s - a);
            const auto share = [&](const Vec3& p, const Vec3& q) { return (p - s).cross(q - s).dot(n); };
            return share(a, b) > 0 && share(b, c) > 0 && share(c, a) > 0;
        };
        std::vector<double> expected;
        const int pieces = 1000;
        double before = 0, after = 0;
        inside(0, before);
        for (int k = 1; k <= pieces; ++k, before = after) {
            const bool in = inside(static_cast<double>(k) / pieces, after);
            if (in && (before > 0) != (after > 0)) expected.push_back((k - 0.5) / pieces);
        }
        const auto met = facet.crossings(s0, s1);
        // a piece in which the path comes near an edge, or meets the plane twice, can be told wrong by the pieces only
        if (met.size() != expected.size()) {
            ++disagree;
            continue;
        }
        for (std::size_t k = 0; k < met.size(); ++k) EXPECT_NEAR(met[k].time, expected[k], 1.0 / pieces);
        crossings += static_cast<int>(met.size());
    }
    EXPECT_GT(crossings, 200);
    EXPECT_LT(disagree, 20);
}

/// A closed surface of many facets, bent and set in motion at random: whoever starts outside and ends inside goes in once
/// more than out, also through edges and corners.
TEST(PathCrossing, LetsNothingSlipThroughEdgesAndCorners) {
    const int n = 8;
    std::vector<Vec3> x0, x1;
    std::vector<Corners> facets;
    osculate::support::Random random(3);
    for (int j = 0; j <= n; ++j)
        for (int i = 0; i <= n; ++i) {
            const double u = static_cast<double>(i) / n, v = static_cast<double>(j) / n;
            x0.emplace_back(u, v, 0.02 * random.vector().x());
            x1.push_back(x0.back() + Vec3(0, 0, 0.5) + 0.02 * random.vector());
            if (i < n && j < n) {
                const Index k = j * (n + 1) + i;
                facets.push_back({k, k + 1, k + n + 2, k + n + 1});
            }
        }
    const MovingFacets sheet(facets, x0, x1);
    for (int j = 1; j < 4 * n; ++j)
        for (int i = 1; i < 4 * n; ++i) { // quarter points of the facets: vertices, edges, diagonals among them
            const Vec3 s(i / (4. * n), j / (4. * n), 0.25);
            EXPECT_TRUE(sheet.first_passage(s, s, none_allowed)) << i << " " << j;
        }
    for (std::size_t v = 0; v < x0.size(); ++v) { // hit by a vertex exactly
        const Vec3 half = 0.5 * (x0[v] + x1[v]);
        if (half.x() > 0.1 && half.x() < 0.9 && half.y() > 0.1 && half.y() < 0.9) {
            EXPECT_TRUE(sheet.first_passage(half, half, none_allowed)) << v;
        }
    }
}

TEST(PathCrossing, CallsADipWithinTheAllowanceASkim) {
    // a hollow of two facets that meet at 90 + 80 degrees; a path along its smooth bottom
    const std::vector<Vec3> x{{-1, 0, 0.1}, {0, 0, 0}, {1, 0, 0.1}, {1, 1, 0.1}, {0, 1, 0}, {-1, 1, 0.1}};
    const std::vector<Corners> hollow{{0, 1, 4, 5}, {1, 2, 3, 4}};
    const MovingFacets facets(hollow, x, x);
    const Vec3 from(-0.9, 0.5, 0.1), to(0.3, 0.5, 0.02);
    EXPECT_TRUE(facets.first_passage(from, to, none_allowed));
    EXPECT_FALSE(facets.first_passage(from, to, [](Index) { return 0.05; }));
    EXPECT_TRUE(facets.first_passage(from, {0.3, 0.5, -0.1}, [](Index) { return 0.05; }));
}

/// Two triangles that share an edge, each numbered from any of its corners: every edge has the tolerance, whichever it is.
TEST(PathCrossing, LeavesNoLeakAtAnyEdgeWhateverTheCornersNumbering) {
    const std::vector<Vec3> x{{0.1, 0.2, 0.3}, {1.3, 0.9, 0.1}, {0.2, 1.4, 0.5}, {1.1, -0.6, 0.2}};
    const Vec3 above(0.1, -0.2, 0.7);
    for (std::size_t first = 0; first < 3; ++first)
        for (std::size_t second = 0; second < 3; ++second) {
            Corners left{0, 1, 2, -1}, right{1, 0, 3, -1};
            std::rotate(left.begin(), left.begin() + first, left.begin() + 3);
            std::rotate(right.begin(), right.begin() + second, right.begin() + 3);
            const MovingFacets roof({left, right}, x, x);
            for (int k = 1; k < 10; ++k) {
                const Vec3 on = x[0] + k / 10.0 * (x[1] - x[0]);
                EXPECT_EQ(roof.crossings(on + above, on - above).size(), 2u) << first << second << k;
            }
        }
}

TEST(Thickness, IsThatOfTheBodyBehindEveryFacet) {
    const Box box({3, 2, 0.1});
    const std::vector<double> thickness = thickness_behind(box.facets, box.facets, box.x);
    const double expected[] = {0.1, 0.1, 2, 3, 2, 3};
    for (std::size_t f = 0; f < 6; ++f) EXPECT_NEAR(thickness[f], expected[f], 1e-9) << f;
}

TEST(Thickness, IsTheLeastOverAFacet) {
    Box wedge({1, 1, 1}); // its top slopes from 1 to 0.2 along x
    for (Vec3& x : wedge.x)
        if (x.z() == 1 && x.x() == 1) x.z() = 0.2;
    const double lowest = 1 - 0.8 * (0.5 + 0.75 * 0.5); // three quarters of the way to the corners
    EXPECT_NEAR(thickness_behind(wedge.facets, wedge.facets, wedge.x)[0], lowest, 1e-9);
}

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
