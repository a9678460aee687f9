/// Sensitivities of samples to their inputs.

#include "osculate/study/sensitivity.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace osculate::study::OSCULATE_THIS_FILE {
namespace {

/// All corners and the middle of a box: inputs that have nothing to do with one another.
Eigen::MatrixXd corners() {
    Eigen::MatrixXd x(5, 2);
    x << 0, 0, 0, 1, 1, 0, 1, 1, 0.5, 0.5;
    return x;
}

/// y = 3 a - 4 b with independent inputs of equal variance: coefficients 3/5 and -4/5.
TEST(Sensitivity, OfALinearOutputIsItsShareOfTheDeviation) {
    const Eigen::MatrixXd x = corners();
    const auto s = sensitivity(x, 7 + (3 * x.col(0) - 4 * x.col(1)).array());
    ASSERT_TRUE(s);
    EXPECT_NEAR(s->coefficients[0], 0.6, 1e-14);
    EXPECT_NEAR(s->coefficients[1], -0.8, 1e-14);
    EXPECT_NEAR(s->determination, 1, 1e-14);
}

TEST(Sensitivity, IsNoMatterOfUnits) {
    const Eigen::MatrixXd x = corners();
    const Eigen::VectorXd y = x.col(0).array().exp() - x.col(1).array();
    Eigen::MatrixXd other = x;
    other.col(0) = 1e9 * x.col(0).array() + 273;
    const auto a = sensitivity(x, y), b = sensitivity(other, 1e-250 * y);
    ASSERT_TRUE(a && b);
    EXPECT_LT((a->coefficients - b->coefficients).norm(), 1e-12);
    EXPECT_LT((a->rank_correlations - b->rank_correlations).norm(), 1e-12);
}

/// A steep output that only rises: rank 1, although a line explains little of it.
TEST(Sensitivity, OfAMonotonousOutputHasRankOne) {
    const int n = 20;
    Eigen::MatrixXd x(n, 1);
    Eigen::VectorXd y(n);
    for (int i = 0; i < n; ++i) {
        x(i, 0) = i;
        y[i] = -std::exp(2.0 * i);
    }
    const auto s = sensitivity(x, y);
    ASSERT_TRUE(s);
    EXPECT_NEAR(s->rank_correlations[0], -1, 1e-14);
    EXPECT_LT(s->determination, 0.5);
}

/// Ranks 0.5, 0.5, 2, 3 and 0 to 3: correlation 4.5 / sqrt(4.5 * 5).
TEST(Sensitivity, SharesRanksAmongEqualOutputs) {
    Eigen::MatrixXd x(4, 1);
    x << 1, 2, 3, 4;
    const auto s = sensitivity(x, Eigen::Vector4d(5, 5, 6, 9));
    ASSERT_TRUE(s);
    EXPECT_NEAR(s->rank_correlations[0], 4.5 / std::sqrt(22.5), 1e-14);
}

TEST(Sensitivity, IsNoneWhereNothingVariesOrSamplesAreTooFew) {
    const Eigen::MatrixXd x = corners();
    EXPECT_FALSE(sensitivity(x, Eigen::VectorXd::Constant(5, 1.1)));
    EXPECT_FALSE(sensitivity(x.topRows(3), Eigen::Vector3d(1, 2, 3)));
    EXPECT_FALSE(sensitivity(Eigen::MatrixXd::Constant(5, 1, 2), Eigen::VectorXd::LinSpaced(5, 0, 1)));
    EXPECT_FALSE(sensitivity(Eigen::MatrixXd(5, 0), Eigen::VectorXd::LinSpaced(5, 0, 1)));
}

} // namespace
} // namespace osculate::study::OSCULATE_THIS_FILE
