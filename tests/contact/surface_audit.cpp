/// Bodies inside one another, against what boxes, cylinders and shells are known to do.

#include "osculate/contact/surface_audit.hpp"

#include "osculate/mesh/generators.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

constexpr double round_off = 1e-12;

/// Bodies with their facets in one numbering.
struct Bodies {
    std::vector<std::vector<mesh::Facet>> facets;
    std::vector<Vec3> X;

    void add(const mesh::Mesh& mesh, const Mat3& turn = Mat3::Identity(), const Vec3& shift = Vec3::Zero()) {
        const auto first = static_cast<Index>(X.size());
        for (const Vec3& node : mesh.nodes) X.push_back(turn * node + shift);
        facets.push_back(mesh::exterior_facets(mesh));
        for (mesh::Facet& facet : facets.back())
            for (int c = 0; c < facet.count; ++c) facet.nodes[static_cast<std::size_t>(c)] += first;
    }
    [[nodiscard]] AuditResult examine() const { return SurfaceAudit(facets, X).examine(X); }
};

mesh::Mesh box(const Vec3& size, const std::array<Index, 3>& divisions) {
    return mesh::make_block(Vec3(-0.5 * size), size, divisions);
}

Mat3 turn(double angle, const Vec3& axis) {
    return Eigen::AngleAxisd(angle, axis.normalized()).toRotationMatrix();
}

/// By how much two boxes overlap along the axis that separates them best, < 0 apart.   [Gottschalk 1996]
double overlap(const Vec3& half, const Mat3& A, const Vec3& a, const Mat3& B, const Vec3& b) {
    double least = std::numeric_limits<double>::max();
    const auto along = [&](const Vec3& axis) {
        if (axis.norm() < 1e-9) return;
        const Vec3 n = axis.normalized();
        double reach = 0;
        for (int k = 0; k < 3; ++k) reach += half(k) * (std::abs(n.dot(A.col(k))) + std::abs(n.dot(B.col(k))));
        least = std::min(least, reach - std::abs(n.dot(b - a)));
    };
    for (int i = 0; i < 3; ++i) {
        along(A.col(i));
        along(B.col(i));
        for (int j = 0; j < 3; ++j) along(A.col(i).cross(B.col(j)));
    }
    return least;
}

TEST(SurfaceAudit, FindsBoxesInsideOneAnotherExactlyWhereNoAxisSeparatesThem) {
    constexpr double doubt = 1e-6; // of the size: what touches is neither
    std::mt19937 random(7);
    std::uniform_real_distribution<double> number(-1, 1);
    const Vec3 half(0.5, 0.6, 0.4);
    const mesh::Mesh one = box(2 * half, {2, 2, 2}), other = box(2 * half, {3, 1, 2});
    int inside = 0, apart = 0;
    for (int k = 0; k < 1000; ++k) {
        const auto any = [&] { return Vec3(number(random), number(random), number(random)); };
        const Mat3 A = turn(3 * number(random), any()), B = turn(3 * number(random), any());
        const Vec3 a = any(), b = any();
        const double depth = overlap(half, A, a, B, b);
        if (std::abs(depth) < doubt) continue;
        Bodies bodies;
        bodies.add(one, A, a);
        bodies.add(other, B, b);
        const AuditResult found = bodies.examine();
        EXPECT_EQ(found.intrusions.size(), depth > 0 ? 1u : 0u) << k << ", overlap " << depth;
        // no node or point of an edge is farther inside than the boxes would have to be moved
        if (const Intrusion* worst = found.worst(); worst != nullptr) {
            EXPECT_LE(worst->depth, depth + half.maxCoeff());
        }
        ++(depth > 0 ? inside : apart);
    }
    EXPECT_GT(inside, 100);
    EXPECT_GT(apart, 100);
}

TEST(SurfaceAudit, MeasuresTheDepthOfAFaceBelowAFace) {
    for (const double depth : {1e-6, 1e-3, 0.1}) {
        Bodies bodies;
        bodies.add(box({1, 1, 1}, {2, 2, 2}));
        bodies.add(box({0.6, 0.6, 1}, {3, 3, 1}), turn(0.3, Vec3::UnitZ()), {0.01, 0.02, 1 - depth});
        const AuditResult found = bodies.examine();
        ASSERT_NE(found.worst(), nullptr) << depth;
        EXPECT_NEAR(found.worst()->depth, depth, round_off);
        EXPECT_NEAR(found.worst()->excess, depth, round_off) << "flat faces have no sagitta";
        EXPECT_EQ(found.nodes.size(), 17u) << "all nodes of the lower face, and the one in the middle of the upper";
        EXPECT_DOUBLE_EQ(found.between(0, 1), found.worst()->excess);
    }
}

TEST(SurfaceAudit, SeesNothingInBodiesThatTouch) {
    Bodies bodies;
    bodies.add(box({1, 1, 1}, {2, 2, 2}));
    bodies.add(box({0.6, 0.6, 1}, {3, 3, 1}), turn(0.3, Vec3::UnitZ()), {0.01, 0.02, 1});
    EXPECT_EQ(bodies.examine().worst(), nullptr);
}

TEST(SurfaceAudit, SeesEdgesThatCrossBetweenTheirNodes) {
    // ridges of 90 degrees along x and y; the upper one lies `depth` below the lower one: the middle of the part inside is
    // that far below the ridge, and depth/sqrt(2) from both flanks
    constexpr double depth = 0.01;
    const double ridge = std::sqrt(0.5);
    Bodies bodies;
    bodies.add(box({3, 1, 1}, {3, 2, 2}), turn(std::numbers::pi / 4, Vec3::UnitX()), {0, 0, ridge - 0.5 * depth});
    bodies.add(box({1, 3, 1}, {2, 3, 2}), turn(std::numbers::pi / 4, Vec3::UnitY()), {0, 0, -ridge + 0.5 * depth});
    const AuditResult found = bodies.examine();
    ASSERT_NE(found.worst(), nullptr);
    EXPECT_TRUE(found.worst()->edge);
    EXPECT_NEAR(found.worst()->depth, depth * std::sqrt(0.5), round_off);
    EXPECT_TRUE(found.nodes.empty());
}

TEST(SurfaceAudit, SeesSlicesThatOverlapThoughTheirNodesLieOnTheOthersFaces) {
    // both end at z = 0.5 and z = -0.5; no edge crosses a facet and no node is inside
    constexpr double depth = 0.1;
    for (const Index layers : {1, 2}) {
        Bodies bodies;
        bodies.add(box({3, 1, 1}, {3, 2, layers}));
        bodies.add(box({1, 1, 1}, {1, 1, layers}), Mat3::Identity(), {0, 1 - depth, 0});
        const AuditResult found = bodies.examine();
        ASSERT_NE(found.worst(), nullptr) << layers;
        EXPECT_NEAR(found.worst()->excess, depth, round_off) << layers;
    }
}

TEST(SurfaceAudit, SeesAFineBallInTheMiddleOfACoarseFacet) {
    // no node of the floor is near; the curvature of the ball times the facet's size squared would excuse any depth
    constexpr double depth = 0.08, size = 0.25, radius = 0.05;
    Bodies bodies;
    bodies.add(box({1, 1, 1}, {4, 4, 2}), Mat3::Identity(), {0, 0, -0.5});
    bodies.add(mesh::make_ball(radius, {4, 4, 4}), Mat3::Identity(), {0.5 * size, 0.5 * size, radius - depth});
    const AuditResult found = bodies.examine();
    ASSERT_NE(found.worst(), nullptr);
    constexpr double arc = 40 * std::numbers::pi / 180; // all that is excused of the ball
    EXPECT_NEAR(found.worst()->excess, depth - size / 8 * arc, 1e-3) << "the lowest node of the ball";
}

TEST(SurfaceAudit, SeesABodyInsideAnotherWhole) {
    Bodies bodies;
    bodies.add(box({1, 1, 1}, {2, 2, 2}));
    bodies.add(box({0.2, 0.2, 0.2}, {1, 1, 1}), Mat3::Identity(), {0.1, 0.1, 0.1});
    const AuditResult found = bodies.examine();
    ASSERT_NE(found.worst(), nullptr);
    EXPECT_NEAR(found.worst()->depth, 0.5, round_off) << "the node at the centre of the large one";
    EXPECT_EQ(found.nodes.size(), 8u);
}

TEST(SurfaceAudit, LetsABodyLieInTheVoidOfAnother) {
    Bodies bodies;
    bodies.add(mesh::make_tube(0.5, 0.2, 1, {24, 2, 2}));
    bodies.add(box({0.4, 0.4, 0.4}, {2, 2, 2}), Mat3::Identity(), {0, 0, 0.5});
    EXPECT_EQ(bodies.examine().worst(), nullptr);
}

TEST(SurfaceAudit, AllowsSmoothSurfacesTheirSagitta) {
    // the vertices of one circle lie on the arc above the chords of the other
    for (const Index around : {12, 24, 48}) {
        Bodies bodies;
        bodies.add(mesh::make_tube(0.3, 0.2, 1, {around, 2, 1}));
        bodies.add(mesh::make_tube(0.5, 0.2, 1, {around, 2, 1}), turn(std::numbers::pi / around, Vec3::UnitZ()));
        const AuditResult found = bodies.examine();
        ASSERT_NE(found.worst(), nullptr);
        EXPECT_GT(found.worst()->depth, 0.5 * 0.5 * (1 - std::cos(std::numbers::pi / around)));
        EXPECT_EQ(found.worst()->excess, 0) << around;
    }
}

TEST(SurfaceAudit, LetsWarpedSurfacesTouch) {
    // z = x y on both sides, bilinear facets hold it exactly; their triangles do not
    Bodies bodies;
    bodies.add(box({1, 1, 1}, {2, 2, 2}));
    bodies.add(box({1, 1, 1}, {3, 3, 1}), Mat3::Identity(), {0, 0, 1});
    for (Vec3& X : bodies.X) X.z() += X.x() * X.y();
    const AuditResult found = bodies.examine();
    ASSERT_NE(found.worst(), nullptr);
    EXPECT_GT(found.worst()->depth, 1e-3);
    EXPECT_EQ(found.worst()->excess, 0);
}

TEST(SurfaceAudit, AllowsAWarpedFacetThatBendsNowhereItsWarpAlone) {
    // one facet a side: what is around it is beyond edges, so that no curvature is allowed for
    const auto excess = [](double sunk) {
        Bodies bodies;
        bodies.add(box({1, 1, 1}, {1, 1, 1}));
        bodies.add(box({0.3, 0.3, 1}, {1, 1, 1}), Mat3::Identity(), {0, 0, 1});
        for (std::size_t i = 0; i < bodies.X.size(); ++i)
            bodies.X[i].z() += bodies.X[i].x() * bodies.X[i].y() - (i < 8 ? 0 : sunk);
        const AuditResult found = bodies.examine();
        return found.worst() == nullptr ? -1 : found.worst()->excess;
    };
    constexpr double warp = 0.25; // |x_0 - x_1 + x_2 - x_3| / 4 of z = x y at half a facet
    EXPECT_EQ(excess(0), 0) << "and not -1: triangles cut the bilinear facet";
    EXPECT_GT(excess(1.2 * warp), 0);
}

TEST(SurfaceAudit, LetsTurnsOfACoilLieSideBySide) {
    // planes of facets cut edges of the next turn, facets do not
    Bodies bodies;
    bodies.add(mesh::make_block(Vec3::Zero(), {12, 1, 0.2}, {48, 1, 1}));
    const SurfaceAudit audit(bodies.facets, bodies.X);
    const auto coiled = [&](double pitch) {
        constexpr double radius = 0.9;
        std::vector<Vec3> x;
        for (const Vec3& X : bodies.X) {
            const double angle = X.x() / radius;
            x.emplace_back((radius - X.z()) * std::sin(angle), X.y() + pitch * angle / (2 * std::numbers::pi),
                           radius - (radius - X.z()) * std::cos(angle));
        }
        return x;
    };
    EXPECT_EQ(audit.examine(coiled(1.02)).worst(), nullptr) << "1 m wide";
    EXPECT_NE(audit.examine(coiled(0.9)).worst(), nullptr);
}

TEST(SurfaceAudit, SeesABodyThatPassesThroughItself) {
    // a strip rolled up by more than a turn, its ends at the same radius: they overlap
    Bodies bodies;
    bodies.add(mesh::make_block(Vec3::Zero(), {6, 1, 0.2}, {24, 1, 1}));
    const SurfaceAudit audit(bodies.facets, bodies.X);
    const auto rolled = [&](double radius) {
        std::vector<Vec3> x;
        for (const Vec3& X : bodies.X)
            x.emplace_back((radius - X.z()) * std::sin(X.x() / radius), X.y(),
                           radius - (radius - X.z()) * std::cos(X.x() / radius));
        return x;
    };
    EXPECT_EQ(audit.examine(bodies.X).worst(), nullptr);
    EXPECT_EQ(audit.examine(rolled(1.1)).worst(), nullptr) << "6 m of a turn of 6.9 m";
    const AuditResult found = audit.examine(rolled(0.9));
    ASSERT_NE(found.worst(), nullptr) << "6 m of a turn of 5.7 m";
    EXPECT_EQ(found.worst()->body, found.worst()->other);
}

TEST(SurfaceAudit, TellsTheSideAtFacetsThatAreNotConvex) {
    Bodies bodies;
    // a prism, counterclockwise from above
    const std::vector<Vec3> base{{0.3, 0.3, 0}, {-0.2, 1, 0}, {-1, -1, 0}, {1, -0.2, 0}};
    for (const double z : {0.0, 1.0})
        for (const Vec3& corner : base) bodies.X.push_back(corner + Vec3(0, 0, z));
    std::vector<mesh::Facet>& facets = bodies.facets.emplace_back();
    for (const std::array<Index, 4>& nodes :
         {std::array<Index, 4>{3, 2, 1, 0}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}) {
        mesh::Facet& facet = facets.emplace_back();
        facet.nodes = nodes;
        facet.count = 4;
    }
    bodies.X[0].head<2>() = bodies.X[4].head<2>() = Vec2(-0.3, -0.3); // hollow: base and top are darts
    bodies.add(box({0.1, 0.1, 0.6}, {1, 1, 3}), Mat3::Identity(), {0.2, 0.2, -0.1});
    EXPECT_EQ(bodies.examine().worst(), nullptr) << "in the hollow, above and below the plane of the dart";
    bodies.X[0].head<2>() = bodies.X[4].head<2>() = Vec2(0.5, 0.5);
    EXPECT_NE(bodies.examine().worst(), nullptr) << "filled";
}

TEST(SurfaceAudit, FindsTheSameWhereBodiesAreMovedTurnedSwappedOrScaled) {
    const Vec3 size(1, 1, 1);
    const mesh::Mesh one = box(size, {2, 3, 2}), other = box(size, {3, 2, 2});
    const Mat3 R = turn(0.7, {1, 2, 3});
    const Mat3 tilt = turn(0.4, {3, 1, 0});
    const Vec3 shift(0.3, 0.2, 0.85), far(50, -20, 10);
    Bodies plain, moved, swapped, scaled;
    plain.add(one);
    plain.add(other, tilt, shift);
    moved.add(one, R, far);
    moved.add(other, R * tilt, R * shift + far);
    swapped.add(other, tilt, shift);
    swapped.add(one);
    scaled.add(one, 1e-3 * Mat3::Identity());
    scaled.add(other, 1e-3 * tilt, 1e-3 * shift);
    const AuditResult p = plain.examine(), m = moved.examine(), s = swapped.examine(), c = scaled.examine();
    ASSERT_NE(p.worst(), nullptr);
    constexpr double round_off_there = 1e-12 * 50;
    EXPECT_NEAR(m.worst()->depth, p.worst()->depth, round_off_there);
    EXPECT_EQ(s.worst()->depth, p.worst()->depth);
    EXPECT_EQ(s.worst()->body, 1 - p.worst()->body);
    EXPECT_NEAR(c.worst()->depth, 1e-3 * p.worst()->depth, round_off);
    EXPECT_EQ(m.nodes.size(), p.nodes.size());
    EXPECT_EQ(c.nodes.size(), p.nodes.size());
}

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
