#include "osculate/contact/exact_shape.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>
#include <stdexcept>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

std::mt19937 generator(3);

Vec3 random_point() {
    std::uniform_real_distribution<double> uniform(-2, 2);
    return {uniform(generator), uniform(generator), uniform(generator)};
}

const std::vector<Vec2> corners{{-2, 0.5}, {-0.5, 0}, {0.5, 0.8}, {1, -0.5}, {2, -0.4}};

ExtrudedShape extruded(std::vector<ProfilePiece> pieces, bool closed = false) {
    const Mat3 Q = Eigen::AngleAxisd(0.7, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
    return {Vec3(0.1, 0.2, 0.3), Q.col(2), Q.col(0), Q.col(1), std::move(pieces), closed};
}

std::vector<ExactShape> shapes() {
    const Vec3 axis = Vec3(1, 2, -1).normalized();
    std::vector<ExactShape> all{PlaneShape{{0.1, 0.2, 0.3}, axis}};
    for (const bool inside : {false, true}) {
        all.emplace_back(CylinderShape{{0.3, -0.2, 0.1}, axis, 0.8, inside});
        all.emplace_back(SphereShape{{0.3, -0.2, 0.1}, 1.1, inside});
        all.emplace_back(ConeShape{{0.3, -0.2, 0.1}, axis, 0.6, inside});
    }
    all.emplace_back(extruded(line_profile(corners, 0)));
    all.emplace_back(extruded(line_profile(corners, 0.2)));
    all.emplace_back(extruded(smooth_profile(corners)));
    all.emplace_back(extruded(line_profile({{1, 0}, {0, 1}, {-1, 0}, {0, -1}, {1, 0}}, 0.3), true));
    return all;
}

TEST(ExactShape, HasTheGradientAndTheHessianOfItsDistance) {
    constexpr double h = 1e-6, tolerance = 1e-8;
    for (const ExactShape& shape : shapes()) {
        SCOPED_TRACE(shape.index());
        int checked = 0;
        for (int trial = 0; trial < 300; ++trial) {
            const Vec3 p = random_point();
            const ShapePoint at = evaluate(shape, p);
            if (!at.found) continue;
            ASSERT_NEAR(at.normal.norm(), 1, 1e-14);
            ASSERT_LT((at.curvature * at.normal).norm(), 1e-12 * (1 + at.curvature.norm()));
            Vec3 slope;
            Mat3 bend;
            bool smooth = true; // not across a crease or an end
            for (int k = 0; k < 3; ++k) {
                const ShapePoint a = evaluate(shape, p + h * Vec3::Unit(k)), b = evaluate(shape, p - h * Vec3::Unit(k));
                smooth = smooth && a.found && b.found && (a.normal - b.normal).norm() < 1e-3;
                slope(k) = (a.gap - b.gap) / (2 * h);
                bend.col(k) = (a.normal - b.normal) / (2 * h);
            }
            if (!smooth) continue;
            ++checked;
            ASSERT_LT((slope - at.normal).norm(), tolerance);
            // at a joint of arcs the curvature of the two sides differs
            if (std::holds_alternative<ExtrudedShape>(shape) && (bend - at.curvature).norm() > 1e-3) continue;
            ASSERT_LT((bend - at.curvature).norm(), 1e-7 * (1 + at.curvature.squaredNorm()));
        }
        EXPECT_GT(checked, 100);
    }
}

TEST(ExactShape, HasItsFootOnItself) {
    for (const ExactShape& shape : shapes())
        for (int trial = 0; trial < 300; ++trial) {
            const Vec3 p = random_point();
            const ShapePoint at = evaluate(shape, p);
            if (!at.found) continue;
            const ShapePoint foot = evaluate(shape, p - at.gap * at.normal);
            if (foot.found) {
                EXPECT_NEAR(foot.gap, 0, 1e-12) << shape.index();
            }
        }
}

TEST(Profile, RoundsItsCornersAndKeepsItsEnds) {
    const std::vector<ProfilePiece> pieces = line_profile(corners, 0.2);
    ASSERT_EQ(pieces.size(), 7U);
    EXPECT_EQ(pieces.front().begin, corners.front());
    EXPECT_EQ(pieces.back().end, corners.back());
    for (const ProfilePiece& piece : pieces)
        if (piece.bend != 0) {
            EXPECT_NEAR(std::abs(1 / piece.bend), 0.2, 1e-12);
            EXPECT_NEAR((piece.begin - piece.centre).norm(), 0.2, 1e-12);
            EXPECT_NEAR((piece.end - piece.centre).norm(), 0.2, 1e-12);
        }
    EXPECT_THROW((void)line_profile(corners, 2), std::invalid_argument);
    EXPECT_THROW((void)line_profile({{0, 0}, {1, 0}, {0, 0}}, 0.1), std::invalid_argument);
}

/// Points of a circle give this circle; others a curve through them without corners.
TEST(Profile, IsSmoothThroughItsPoints) {
    std::vector<Vec2> circle;
    for (const double angle : {0.0, 0.5, 0.8, 1.5, 2.0}) circle.emplace_back(2 * std::cos(angle), 2 * std::sin(angle));
    for (const ProfilePiece& piece : smooth_profile(circle)) {
        EXPECT_NEAR(piece.bend, 0.5, 1e-9);
        EXPECT_LT(piece.centre.norm(), 1e-9);
    }
    const std::vector<ProfilePiece> pieces = smooth_profile(corners);
    const auto left = [](const ProfilePiece& piece, const Vec2& at) {
        if (piece.bend == 0)
            return Vec2(Eigen::Rotation2Dd(std::numbers::pi / 2) * (piece.end - piece.begin).normalized());
        return Vec2((piece.bend > 0 ? -1 : 1) * (at - piece.centre).normalized());
    };
    for (std::size_t k = 1; k < pieces.size(); ++k) {
        EXPECT_LT((pieces[k].begin - pieces[k - 1].end).norm(), 1e-14);
        EXPECT_LT((left(pieces[k], pieces[k].begin) - left(pieces[k - 1], pieces[k - 1].end)).norm(), 1e-9);
    }
    for (const Vec2& corner : corners) {
        double nearest = 1;
        for (const ProfilePiece& piece : pieces)
            nearest = std::min({nearest, (piece.begin - corner).norm(), (piece.end - corner).norm()});
        EXPECT_LT(nearest, 1e-14);
    }
}

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
