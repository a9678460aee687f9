/// Overlaps of slave and master facets, as points to integrate at.

#include "osculate/contact/facet_overlap.hpp"

#include "osculate/contact/facet_patch.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

constexpr double round_off = 1e-14;

using Corners = std::vector<Vec3>;

/// Counter-clockwise seen from above, so with its outside up.
Corners rectangle(double x0, double y0, double x1, double y1, double z = 0) {
    return {{x0, y0, z}, {x1, y0, z}, {x1, y1, z}, {x0, y1, z}};
}
/// The same facet as the surface of a body above it, so with its outside down.
Corners turned_over(Corners corners) {
    std::reverse(corners.begin(), corners.end());
    return corners;
}

Vec3 position(const Corners& corners, const Vec2& u) {
    Vector N(static_cast<Index>(corners.size()));
    MatrixX2 N_a(N.size(), 2);
    FacetPatch(static_cast<int>(corners.size())).weights(u, N, N_a);
    Vec3 x = Vec3::Zero();
    for (Index i = 0; i < N.size(); ++i) x += N(i) * corners[static_cast<std::size_t>(i)];
    return x;
}

double area(const std::vector<OverlapPoint>& points) {
    double sum = 0;
    for (const OverlapPoint& q : points) sum += q.area;
    return sum;
}

TEST(FacetOverlap, IsTheCommonPartOfTwoRectangles) {
    const Corners slave = turned_over(rectangle(0, 0, 2, 1, 0.1)), master = rectangle(1.5, -1, 4, 0.25);
    const auto points = SlavePlane(slave).overlap(master);
    EXPECT_NEAR(area(points), 0.5 * 0.25, round_off);
    for (const OverlapPoint& q : points) {
        const Vec3 s = position(slave, q.xi), m = position(master, q.u);
        EXPECT_LT((s - m - Vec3(0, 0, 0.1)).norm(), 1e-13); // one above the other
        EXPECT_TRUE(s.x() > 1.5 && s.x() < 2 && s.y() > 0 && s.y() < 0.25);
    }
}

TEST(FacetOverlap, IntegratesPolynomialsOfDegreeFourExactly) {
    const auto points = SlavePlane(turned_over(rectangle(0, 0, 1, 1))).overlap(rectangle(-1, -1, 3, 0.5));
    const Corners slave = turned_over(rectangle(0, 0, 1, 1));
    for (int a = 0; a <= 4; ++a)
        for (int b = 0; a + b <= 4; ++b) {
            double sum = 0;
            for (const OverlapPoint& q : points) {
                const Vec3 x = position(slave, q.xi);
                sum += q.area * std::pow(x.x(), a) * std::pow(x.y(), b);
            }
            EXPECT_NEAR(sum, std::pow(0.5, b + 1) / (a + 1) / (b + 1), round_off) << a << ' ' << b;
        }
}

TEST(FacetOverlap, OfATilingAddsUpToTheFacet) {
    Corners slave{{0.3, 0.2, 0}, {2.1, 0.4, 0}, {1.7, 1.9, 0}, {0.2, 1.6, 0}};
    const double whole = SlavePlane(slave).area();
    slave = turned_over(slave);
    double sum = 0;
    for (int i = 0; i < 5; ++i)
        for (int k = 0; k < 5; ++k) { // triangles of a grid
            const double x = 0.5 * i, y = 0.5 * k, h = 0.5;
            sum += area(SlavePlane(slave).overlap(Corners{{x, y, 0}, {x + h, y, 0}, {x + h, y + h, 0}}));
            sum += area(SlavePlane(slave).overlap(Corners{{x, y, 0}, {x + h, y + h, 0}, {x, y + h, 0}}));
        }
    EXPECT_NEAR(sum, whole, 10 * round_off);
}

TEST(FacetOverlap, TurnsWithTheFacets) {
    const Mat3 turn = Eigen::AngleAxisd(1.1, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
    Corners slave = turned_over(rectangle(0, 0, 1, 1, 0.05)), master{{0.4, 0.4, 0}, {2, 0.4, 0}, {0.4, 2, 0}};
    const double there = area(SlavePlane(slave).overlap(master));
    EXPECT_NEAR(there, 0.36, round_off);
    for (Corners* corners : {&slave, &master})
        for (Vec3& x : *corners) x = turn * x + Vec3(10, 20, 30);
    EXPECT_NEAR(area(SlavePlane(slave).overlap(master)), there, 1e-12);
}

TEST(FacetOverlap, IsEmptyApartBesideAndBack) {
    const SlavePlane plane(turned_over(rectangle(0, 0, 1, 1)));
    EXPECT_TRUE(plane.overlap(rectangle(2, 0, 3, 1)).empty());
    EXPECT_TRUE(plane.overlap(rectangle(1, 0, 2, 1)).empty());              // a common edge
    EXPECT_TRUE(plane.overlap(turned_over(rectangle(0, 0, 1, 1))).empty()); // does not face it
}

TEST(NaturalCoordinates, InvertTheMapOfADistortedQuadrilateral) {
    const std::vector<Vec2> corners{{0, 0}, {2, 0.3}, {1.5, 1.8}, {-0.4, 1.1}};
    for (const Vec2& u : {Vec2(0.3, -0.7), Vec2(-1, 1), Vec2(0, 0)}) {
        Vector N(4);
        MatrixX2 N_a(4, 2);
        FacetPatch(4).weights(u, N, N_a);
        Vec2 x = Vec2::Zero();
        for (Index i = 0; i < 4; ++i) x += N(i) * corners[static_cast<std::size_t>(i)];
        const auto found = natural_coordinates(corners, x);
        ASSERT_TRUE(found);
        EXPECT_LT((*found - u).norm(), 1e-13);
    }
}

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
