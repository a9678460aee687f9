#include "osculate/contact/projection.hpp"

#include "osculate/contact/facet_patch.hpp"
#include "osculate/contact/rpim_patch.hpp"
#include "support/differences.hpp"
#include "support/floating_point_traps.hpp"
#include "support/random.hpp"

#include <gtest/gtest.h>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

using osculate::support::central_differences;
using osculate::support::Random;
using osculate::support::relative_difference;

/// Feet come with round-off of about 1e-13 (weights of condition 1e5): over the step 1e-4 that is 1e-9, and the step
/// squared times third derivatives is a few 1e-8.
constexpr double step = 1e-4, difference_tolerance = 1e-6;
constexpr double round_off = 1e-12;

/// A patch and the positions of its nodes, and where to look.
template <class Patch> struct Surface {
    Patch patch;
    MatrixX3 x;
    std::vector<Vec2> at;
};

Surface<FacetPatch> warped_quadrilateral() {
    MatrixX3 x(4, 3);
    x << 0, 0, 0, 1.1, 0.1, 0.2, 1.2, 0.9, -0.1, -0.1, 1, 0.3;
    return {FacetPatch(4), x, {{0.1, -0.2}, {0.7, 0.6}, {-1.1, 0.4}}};
}

Surface<FacetPatch> triangle() {
    MatrixX3 x(3, 3);
    x << 0, 0, 0, 1.1, 0.1, 0.2, 0.3, 0.9, -0.1;
    return {FacetPatch(3), x, {{0.3, 0.3}, {0.8, 0.1}, {-0.1, 0.5}}};
}

/// Patch over the bowl z = x^2/4 - xy/8 + y^2/2 (scaled by `height`), with nodes shaken in all directions.
Surface<RpimPatch> bowl(const Multiquadric& basis, int m, double height = 1) {
    Random random(5);
    MatrixX2 u(16, 2);
    MatrixX3 x(16, 3);
    for (Index i = 0; i < 16; ++i) {
        const Vec2 p(i % 4 - 1.5 + random.uniform(-0.1, 0.1), i / 4 - 1.5 + random.uniform(-0.1, 0.1));
        u.row(i) = p.transpose();
        const double z = height * (p.x() * p.x() / 4 - p.x() * p.y() / 8 + p.y() * p.y() / 2);
        x.row(i) = (Vec3(p.x(), p.y(), z) + random.vector(0.05)).transpose();
    }
    return {*RpimPatch::fit(u, basis, m), x, {{0.1, -0.2}, {0.45, 0.4}, {-0.6, 0.3}}};
}

/// Slave point at distance `gap` over the surface at u.
template <class Patch> Vec3 above(const Surface<Patch>& surface, const Vec2& u, double gap) {
    const PatchPoint p = surface.patch.point(u, surface.patch.coefficients(surface.x));
    return p.X + gap * p.normal();
}

/// Foot coordinates, normal and gap as a function of y = (s, x_1 .. x_n).
template <class Patch> Vector evaluate(const Patch& patch, const Vector& y, const Vec2& start) {
    const Vec3 s = y.head<3>();
    const MatrixX3 x = y.tail(y.size() - 3).reshaped(3, patch.size()).transpose();
    const auto foot = project(patch, patch.coefficients(x), s, start);
    if (!foot) throw std::runtime_error("no foot");
    const Vec3 n = foot->point.normal();
    Vector result(6);
    result << foot->u, n, n.dot(s - foot->point.X);
    return result;
}

template <class Patch> void check(const Surface<Patch>& surface, double gap) {
    const Index n = surface.patch.size();
    for (const Vec2& u : surface.at) {
        const Vec3 s = above(surface, u, gap);
        const Vec2 start = u + Vec2(0.05, -0.08);
        const auto foot = project(surface.patch, surface.patch.coefficients(surface.x), s, start);
        ASSERT_TRUE(foot);
        EXPECT_LT((foot->u - u).norm(), round_off);
        EXPECT_LT((foot->point.X_a.transpose() * (s - foot->point.X)).norm(), round_off) << "not a perpendicular";

        ContactPoint point;
        ContactVariation variation;
        ASSERT_TRUE(locate(surface.patch, *foot, s, point));
        vary(surface.patch, *foot, point, variation);
        EXPECT_NEAR(point.gap, gap, round_off);
        EXPECT_NEAR(std::abs(point.gap), (s - point.foot).norm(), round_off);
        EXPECT_LT((point.foot - surface.x.transpose() * point.weights).norm(), round_off);

        Vector y(3 + 3 * n);
        y << s, surface.x.transpose().reshaped();
        const Matrix differences =
            central_differences([&](const Vector& at) { return evaluate(surface.patch, at, u); }, y, step);
        EXPECT_LT(relative_difference(variation.dn, differences.middleRows(2, 3)), difference_tolerance);
        EXPECT_LT(relative_difference(variation.dg, differences.bottomRows(1)), difference_tolerance);
    }
}

/// Distances above, below and on the surface, within its radii of curvature.
constexpr double gaps[] = {0.3, 0.01, 0.0, -0.01, -0.3};

TEST(Projection, HasExactVariationsOnAWarpedQuadrilateral) {
    for (const double gap : gaps) check(warped_quadrilateral(), gap);
}

TEST(Projection, HasExactVariationsOnATriangle) {
    for (const double gap : gaps) check(triangle(), gap);
}

TEST(Projection, HasExactVariationsOnRpimPatches) {
    for (const double gap : gaps) {
        check(bowl({}, 6), gap);
        check(bowl({}, 3), gap);
        check(bowl({0, 2.5}, 6), gap);
    }
}

TEST(Projection, FindsAFlatFootFromFarAway) {
    const auto surface = triangle();
    const Vec2 u(0.3, 0.3);
    const auto foot = project(surface.patch, surface.x, above(surface, u, 50), Vec2(5, -3));
    ASSERT_TRUE(foot);
    const double far = 50; // round-off grows with the distance
    EXPECT_LT((foot->u - u).norm(), far * round_off);
}

/// A cylinder of radius 2 about the y axis, hollow side up, as an RPIM patch of true angles.
Surface<RpimPatch> hollow_cylinder() {
    constexpr double radius = 2;
    MatrixX2 u(25, 2);
    MatrixX3 x(25, 3);
    for (Index i = 0; i < 25; ++i) {
        const double arc = 0.3 * (i % 5 - 2), y = 0.3 * (i / 5 - 2);
        u.row(i) << arc, y;
        x.row(i) << radius * std::sin(arc / radius), y, -radius * std::cos(arc / radius);
    }
    return {*RpimPatch::fit(u, {}, 6), x, {Vec2(0.03, 0.1)}};
}

TEST(Projection, IsRejectedNearTheCentreOfCurvature) {
    const auto surface = hollow_cylinder();
    const MatrixX3 coefficients = surface.patch.coefficients(surface.x);
    const Vec2 u = surface.at[0];
    const auto accepted = [&](double gap) {
        ContactPoint point;
        const Foot foot{u, surface.patch.point(u, coefficients)};
        return locate(surface.patch, foot, above(surface, u, gap), point);
    };
    // the limit is 0.8 of the radius 2, which the patch meets to a few per cent
    EXPECT_TRUE(accepted(0.75 * 2));
    EXPECT_FALSE(accepted(0.85 * 2));
    EXPECT_FALSE(accepted(1.5 * 2));
    EXPECT_TRUE(accepted(-1.5 * 2)) << "the other side has no centre of curvature";
}

TEST(Projection, IsRejectedInsideABall) {
    // the bowl turned over, seen from its hollow side below: the limit is on the side of negative gaps
    const auto surface = bowl({}, 6, -1);
    const MatrixX3 coefficients = surface.patch.coefficients(surface.x);
    const Vec2 u(0.1, -0.2);
    const Foot foot{u, surface.patch.point(u, coefficients)};
    ContactPoint point;
    EXPECT_FALSE(locate(surface.patch, foot, above(surface, u, -2), point)); // radii of curvature are 1 and 2
    EXPECT_TRUE(locate(surface.patch, foot, above(surface, u, 2), point));
}

TEST(Projection, ReportsPositionsThatAreNotNumbers) {
    const support::FloatingPointTraps suspended(false); // a comparison with NaN is an invalid operation
    const auto surface = warped_quadrilateral();
    EXPECT_FALSE(project(surface.patch, surface.x, Vec3::Constant(std::nan("")), Vec2::Zero()));
}

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
