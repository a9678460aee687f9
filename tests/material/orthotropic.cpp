#include "osculate/material/orthotropic.hpp"

#include "osculate/material/linear_elastic.hpp"
#include "osculate/material/voigt.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <gtest/gtest.h>

namespace osculate::material::OSCULATE_THIS_FILE {
namespace {

const Orthotropic wood{{12, 1, 0.5}, {0.4, 0.35, 0.3}, {0.9, 0.8, 0.1}, Mat3::Identity()};

TEST(Orthotropic, OfEqualConstantsIsIsotropic) {
    const LinearElastic hooke{200, 0.3};
    const Orthotropic same{Vec3::Constant(200), Vec3::Constant(0.3), Vec3::Constant(hooke.mu()),
                           Mat3(Eigen::AngleAxisd(1, Vec3(1, 2, 3).normalized()))};
    EXPECT_LT((same.stiffness() - hooke.stiffness()).norm(), 1e-13 * hooke.stiffness().norm());
}

TEST(Orthotropic, TensionAlongAnAxisStretchesAndContractsAsItSays) {
    const Mat6 C = wood.stiffness().inverse();
    EXPECT_NEAR(C(0, 0), 1 / 12.0, 1e-14);
    EXPECT_NEAR(C(1, 0), -0.4 / 12, 1e-14);
    EXPECT_NEAR(C(2, 0), -0.35 / 12, 1e-14);
    EXPECT_NEAR(C(2, 1), -0.3 / 1, 1e-14);
    EXPECT_NEAR(C(3, 3), 1 / 0.9, 1e-13); // xy
    EXPECT_NEAR(C(4, 4), 1 / 0.1, 1e-12); // yz
    EXPECT_NEAR(C(5, 5), 1 / 0.8, 1e-13); // zx
}

TEST(Orthotropic, TurnsWithItsAxes) {
    const Mat3 Q(Eigen::AngleAxisd(0.7, Vec3(1, -2, 0.5).normalized()));
    Orthotropic turned = wood;
    turned.axes = Q;
    const Mat3 strain =
        Mat3(Vec3(0.1, 0.2, -0.3).asDiagonal()) + 0.1 * (Mat3() << 0, 1, 2, 1, 0, 3, 2, 3, 0).finished();
    const Mat3 stress = stress_matrix(wood.stiffness() * strain_vector(strain)),
               other = stress_matrix(turned.stiffness() * strain_vector(Q * strain * Q.transpose()));
    EXPECT_LT((other - Q * stress * Q.transpose()).norm(), 1e-13 * stress.norm());
}

TEST(Orthotropic, KnowsWhatIsNoMaterial) {
    EXPECT_TRUE(wood.stable());
    Orthotropic bad = wood;
    bad.nu[2] = 1.5; // nu_23^2 > E_2/E_3
    EXPECT_FALSE(bad.stable());
}

} // namespace
} // namespace osculate::material::OSCULATE_THIS_FILE
