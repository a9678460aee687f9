#include "osculate/linear/penalty_stiffness.hpp"

#include "block_systems.hpp"

#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace osculate::linear::OSCULATE_THIS_FILE {
namespace {

using osculate::support::Random;

/// Two "elements" of four nodes each that share none; node 1 in a turned frame and held along one axis, node 6 fixed.
struct TwoBodies : ::testing::Test {
    Random random{3};
    BlockMatrix K{8, {{0, 1, 2, 3}, {4, 5, 6, 7}}};
    Constraints constraints{8,
                            {{1, Vec3(1, 2, 2) / 3, 0, false, false, 0},
                             {6, Vec3::UnitX(), 0, false, false, 0},
                             {6, Vec3::UnitY(), 0, false, false, 0},
                             {6, Vec3::UnitZ(), 0, false, false, 0}}};
    Matrix element = Matrix::Zero(12, 12);

    TwoBodies() {
        for (Index i = 0; i < 12; ++i)
            for (Index k = 0; k < 12; ++k) element(i, k) = random.uniform();
        element = (element * element.transpose()).eval();
        K.add({0, 1, 2, 3}, element);
        K.add({4, 5, 6, 7}, element);
    }
    Mat3 positive() {
        Mat3 M;
        for (Index i = 0; i < 9; ++i) M(i) = random.uniform();
        return M * M.transpose();
    }
    /// u^T A u from its definition.
    double energy(const Vector& free, const std::vector<Spring>& springs) const {
        Field u(8), f(8);
        constraints.scatter(free, Field(8), u);
        K.multiply_add(u, f, 1);
        double sum = dot(u, f);
        for (const Spring& s : springs) {
            Vec3 w = u[s.slave];
            for (std::size_t i = 0; i < s.masters.size(); ++i) w -= s.follow[i] * u[s.masters[i]];
            sum += w.dot(s.stiffness * w);
        }
        return sum;
    }
    void check(const PenaltyStiffness& stiffness, const std::vector<Spring>& springs) {
        const Matrix A = fixtures::dense_of(stiffness.matrix());
        ASSERT_EQ(A.rows(), constraints.equations());
        const double round_off = 1e-13 * A.cwiseAbs().maxCoeff();
        EXPECT_LT((A - A.transpose()).cwiseAbs().maxCoeff(), round_off);
        for (int k = 0; k < 20; ++k) {
            Vector u(A.rows());
            for (Index i = 0; i < u.size(); ++i) u(i) = random.uniform();
            EXPECT_NEAR(u.dot(A * u), energy(u, springs), round_off * u.squaredNorm() * static_cast<double>(u.size()));
        }
    }
};

TEST_F(TwoBodies, HaveTheEnergyOfBodiesAndSprings) {
    PenaltyStiffness stiffness(constraints, K);
    stiffness.set_springs({});
    check(stiffness, {});
    // mirror images repeat a node; slave and master may carry constraints
    const Mat3 mirror = Vec3(1, 1, -1).asDiagonal();
    const Mat3 turn = Eigen::AngleAxisd(2, Vec3::UnitZ()).toRotationMatrix(); // an image at two oblique planes
    const std::vector<Spring> springs{
        {1,
         {4, 5, 6, 7},
         {0.1 * Mat3::Identity(), 0.2 * Mat3::Identity(), 0.3 * Mat3::Identity(), 0.4 * mirror},
         positive()},
        {0, {4, 4, 5}, {0.5 * Mat3::Identity(), 0.3 * mirror, 0.2 * turn}, positive()}};
    stiffness.set_springs(springs);
    check(stiffness, springs);
}

TEST_F(TwoBodies, GoBackToThePatternTheyKept) {
    PenaltyStiffness stiffness(constraints, K);
    const std::vector<Spring> near{{2, {4, 5}, {0.5 * Mat3::Identity(), 0.5 * Mat3::Identity()}, positive()}};
    const std::vector<Spring> far{{0, {5, 7}, {0.5 * Mat3::Identity(), 0.5 * Mat3::Identity()}, positive()}};
    stiffness.set_springs(near);
    stiffness.keep_pattern();
    const auto column = stiffness.matrix().column;
    const auto value = stiffness.matrix().value;
    stiffness.set_springs(far);
    EXPECT_NE(stiffness.matrix().column, column);
    stiffness.restore_pattern();
    stiffness.set_springs(near);
    EXPECT_EQ(stiffness.matrix().column, column);
    EXPECT_EQ(stiffness.matrix().value, value);
}

TEST_F(TwoBodies, ForgetEarlierSpringsAndGrowTheirPatternOnlyWhereNeeded) {
    PenaltyStiffness stiffness(constraints, K);
    std::vector<Spring> springs{{2, {4, 5}, {0.5 * Mat3::Identity(), 0.5 * Mat3::Identity()}, positive()}};
    stiffness.set_springs(springs);
    const auto pattern = stiffness.matrix().pattern, revision = stiffness.matrix().revision;
    springs[0].stiffness = positive();
    springs[0].follow[0] *= 0.3;
    stiffness.set_springs(springs);
    check(stiffness, springs);
    EXPECT_EQ(stiffness.matrix().pattern, pattern);
    EXPECT_NE(stiffness.matrix().revision, revision);
    springs[0].masters = {5, 7};
    stiffness.set_springs(springs);
    check(stiffness, springs);
    EXPECT_NE(stiffness.matrix().pattern, pattern);
}

} // namespace
} // namespace osculate::linear::OSCULATE_THIS_FILE
