#include "osculate/model/rotation.hpp"

#include "osculate/model/rigid_body.hpp"

#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace osculate::model::OSCULATE_THIS_FILE {
namespace {

/// From tiny angles, where series take over, to almost half a turn.
constexpr double angles[] = {0, 1e-9, 1e-5, 0.9e-3, 1.1e-3, 0.1, 1, 2.8};
const Vec3 axis = Vec3(1, -2, 0.5).normalized();

template <class F> Mat3 difference(const Vec3& at, F&& f) {
    constexpr double h = 1e-6;
    Mat3 result;
    for (int k = 0; k < 3; ++k) result.col(k) = (f(at + h * Vec3::Unit(k)) - f(at - h * Vec3::Unit(k))) / (2 * h);
    return result;
}

TEST(Rotation, MovesPointsAsCayleysVectorSays) {
    const Vec3 X(0.3, -0.7, 1.1);
    for (const double angle : angles) {
        const Vec3 theta = angle * axis;
        const Vec3 moved = turned_by(turned(Quaternion::Identity(), theta), X);
        EXPECT_LT((moved - cayley(theta).cross(X + moved / 2)).norm(), 1e-14 * (1 + angle)) << angle;
        EXPECT_LT((moved - (Eigen::AngleAxisd(angle, axis) * X - X)).norm(), 1e-15 * (1 + 10 * angle)) << angle;
    }
}

TEST(Rotation, HasTheDerivativesOfItsFormulas) {
    constexpr double tolerance = 1e-8; // of central differences
    const Vec3 X(0.3, -0.7, 1.1);
    for (const double angle : angles) {
        const Vec3 theta = angle * axis;
        EXPECT_LT((cayley_derivative(theta) - difference(theta, [](const Vec3& t) { return cayley(t); })).norm(),
                  tolerance * cayley_derivative(theta).norm())
            << angle;
        // dR X = [T dtheta] R X
        const Mat3 by_theta =
            difference(theta, [&](const Vec3& t) { return turned_by(turned(Quaternion::Identity(), t), X); });
        const Vec3 x = turned(Quaternion::Identity(), theta) * X;
        EXPECT_LT((by_theta + cross_matrix(x) * tangent_map(theta)).norm(), tolerance) << angle;
    }
}

TEST(Rotation, VectorIsContinuousBeyondWholeTurns) {
    Quaternion q = Quaternion::Identity();
    Vec3 vector = Vec3::Zero();
    constexpr int steps = 100;
    const double all = 5 * std::numbers::pi;
    for (int k = 1; k <= steps; ++k) {
        q = turned(q, all / steps * axis);
        vector = rotation_vector(q, vector);
        EXPECT_LT((vector - all * k / steps * axis).norm(), 1e-12);
    }
    for (int k = steps - 1; k >= -steps; --k) { // and back, through nothing
        q = turned(q, -all / steps * axis);
        vector = rotation_vector(q, vector);
        EXPECT_LT((vector - all * k / steps * axis).norm(), 1e-7);
    }
}

TEST(WeightsAbout, HaveTheirCentreWhereItIsAskedFor) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> uniform(-1, 1);
    std::vector<Vec3> nodes;
    for (int i = 0; i < 20; ++i) nodes.emplace_back(uniform(random), uniform(random), 5 + uniform(random));
    const Vec3 point(0.3, 2, 4);
    const std::vector<double> weights = weights_about(nodes, point);
    ASSERT_EQ(weights.size(), nodes.size());
    double sum = 0;
    Vec3 centre = Vec3::Zero();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
        sum += weights[i];
        centre += weights[i] * nodes[i];
    }
    EXPECT_NEAR(sum, 1, 1e-13);
    EXPECT_LT((centre - point).norm(), 1e-12);

    for (Vec3& node : nodes) node.z() = 1; // a plate has no centre above itself
    EXPECT_TRUE(weights_about(nodes, point).empty());
    EXPECT_FALSE(weights_about(nodes, {0.3, 2, 1}).empty());
}

} // namespace
} // namespace osculate::model::OSCULATE_THIS_FILE
