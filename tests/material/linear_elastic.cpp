#include "osculate/material/linear_elastic.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <gtest/gtest.h>

namespace osculate::material::OSCULATE_THIS_FILE {
namespace {

constexpr double round_off = 1e-13; // a handful of operations on numbers of order one
const LinearElastic steel_like{2.0, 0.3};

Mat3 tensor(const Vec6& voigt, double shear_factor) {
    const Vec6 v = voigt;
    const double xy = shear_factor * v[3], yz = shear_factor * v[4], zx = shear_factor * v[5];
    Mat3 t;
    t << v[0], xy, zx, xy, v[1], yz, zx, yz, v[2];
    return t;
}

Vec6 voigt(const Mat3& t, double shear_factor) {
    Vec6 v;
    v << t(0, 0), t(1, 1), t(2, 2), shear_factor * t(0, 1), shear_factor * t(1, 2), shear_factor * t(2, 0);
    return v;
}

TEST(LinearElastic, UniaxialStressStretchesByStressOverYoungAndContractsByPoisson) {
    Vec6 stress;
    stress << 1.5, 0, 0, 0, 0, 0;
    Vec6 expected;
    expected << 1.5 / 2.0, -0.3 * 1.5 / 2.0, -0.3 * 1.5 / 2.0, 0, 0, 0;
    const Vec6 strain = steel_like.stiffness().inverse() * stress;
    EXPECT_LT((strain - expected).norm(), round_off);
}

TEST(LinearElastic, EngineeringShearStrainGivesShearModulusTimesStrain) {
    for (int k = 3; k < 6; ++k) {
        const Vec6 stress = steel_like.stress(Vec6::Unit(k));
        EXPECT_LT((stress - 2.0 / 2.6 * Vec6::Unit(k)).norm(), round_off);
    }
}

TEST(LinearElastic, StressIsStiffnessTimesStrain) {
    for (int k = 0; k < 6; ++k) {
        const Vec6 strain = Vec6::Unit(k);
        EXPECT_LT((steel_like.stress(strain) - steel_like.stiffness() * strain).norm(), round_off);
    }
}

TEST(LinearElastic, StiffnessIsSymmetricAndPositiveDefiniteUpToNearIncompressibility) {
    for (const double nu : {-0.9, 0.0, 0.3, 0.4999}) {
        const Mat6 D = LinearElastic{1.0, nu}.stiffness();
        EXPECT_EQ((D - D.transpose()).norm(), 0);
        EXPECT_GT(Eigen::SelfAdjointEigenSolver<Mat6>(D).eigenvalues().minCoeff(), 0) << "nu = " << nu;
    }
}

TEST(LinearElastic, IsIsotropic) {
    const Mat3 R = Eigen::AngleAxisd(0.7, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
    Vec6 strain;
    strain << 0.3, -0.2, 0.5, 0.7, -0.4, 0.1;
    const Vec6 turned = voigt(R * tensor(strain, 0.5) * R.transpose(), 2);
    const Mat3 expected = R * tensor(steel_like.stress(strain), 1) * R.transpose();
    EXPECT_LT((tensor(steel_like.stress(turned), 1) - expected).norm(), round_off);
}

} // namespace
} // namespace osculate::material::OSCULATE_THIS_FILE
