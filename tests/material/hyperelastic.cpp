#include "osculate/material/neo_hookean.hpp"
#include "osculate/material/saint_venant_kirchhoff.hpp"
#include "osculate/material/voigt.hpp"
#include "support/differences.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <gtest/gtest.h>

namespace osculate::material::OSCULATE_THIS_FILE {
namespace {

const LinearElastic hooke{2.0, 0.3}; // stresses of order one
constexpr double round_off = 1e-13;  // a few dozen operations on numbers of order one
constexpr double step = 1e-5;        // of central differences
constexpr double difference = 1e-8;  // step^2 times third derivatives, relative

Mat3 deformation_gradient() {
    Mat3 F;
    F << 1.2, 0.3, -0.1, 0.05, 0.8, 0.2, -0.15, 0.1, 1.1;
    return F;
}
Mat3 strain_of(const Mat3& F) {
    return (F.transpose() * F - Mat3::Identity()) / 2;
}
/// The strain whose vector (shear components twice) is v.
Mat3 strain_of(const Vec6& v) {
    Mat3 E;
    E << v[0], v[3] / 2, v[5] / 2, v[3] / 2, v[1], v[4] / 2, v[5] / 2, v[4] / 2, v[2];
    return E;
}

template <class Material> class Hyperelastic : public ::testing::Test {
protected:
    const Material material{hooke};
};
using Materials = ::testing::Types<SaintVenantKirchhoff, NeoHookean>;
TYPED_TEST_SUITE(Hyperelastic, Materials);

TYPED_TEST(Hyperelastic, StressIsTheDerivativeOfTheEnergy) {
    const Mat3 E = strain_of(deformation_gradient());
    const Matrix slope = osculate::support::central_differences(
        [&](const Vector& v) { return Vector::Constant(1, this->material.energy(strain_of(Vec6(v)))).eval(); },
        strain_vector(E), step);
    EXPECT_LT((slope.transpose() - stress_vector(this->material.pk2(E))).norm(), difference);
}

TYPED_TEST(Hyperelastic, TangentIsTheDerivativeOfTheStress) {
    const Mat3 E = strain_of(deformation_gradient());
    const Matrix slope = osculate::support::central_differences(
        [&](const Vector& v) { return Vector(stress_vector(this->material.pk2(strain_of(Vec6(v))))); },
        strain_vector(E), step);
    const Mat6 D = this->material.tangent(E);
    EXPECT_LT((slope - D).norm(), difference * D.norm());
    EXPECT_EQ((D - D.transpose()).norm(), 0);
}

TYPED_TEST(Hyperelastic, IsHookesLawAtSmallStrain) {
    EXPECT_LT((this->material.tangent(Mat3::Zero()) - hooke.stiffness()).norm(), round_off);
    // energy is quadratic in a strain of 1e-9, so the digits that C - 1 has there must not be lost
    constexpr double small = 1e-9, digits = 1e-6;
    const Mat3 E = small * strain_of(deformation_gradient());
    const Vec6 v = strain_vector(E), stress = hooke.stress(v);
    EXPECT_LT((stress_vector(this->material.pk2(E)) - stress).norm(), digits * stress.norm());
    EXPECT_NEAR(this->material.energy(E), v.dot(stress) / 2, digits * v.dot(stress));
}

TYPED_TEST(Hyperelastic, HasNoStressAndNoEnergyAtRest) {
    EXPECT_EQ(this->material.energy(Mat3::Zero()), 0);
    EXPECT_EQ(this->material.pk2(Mat3::Zero()).norm(), 0);
}

TYPED_TEST(Hyperelastic, IsIsotropic) {
    const Mat3 Q = Eigen::AngleAxisd(0.7, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
    const Mat3 E = strain_of(deformation_gradient()), turned = Q * E * Q.transpose();
    EXPECT_NEAR(this->material.energy(turned), this->material.energy(E), round_off);
    EXPECT_LT((this->material.pk2(turned) - Q * this->material.pk2(E) * Q.transpose()).norm(), round_off);
}

TEST(SaintVenantKirchhoff, HasTheClosedFormulaOfUniaxialStrain) {
    const SaintVenantKirchhoff material(hooke);
    for (const double stretch : {0.7, 1.0, 1.6}) {
        const Mat3 E = strain_of(Mat3(Vec3(stretch, 1, 1).asDiagonal()));
        const double e = (stretch * stretch - 1) / 2;
        EXPECT_NEAR(material.pk2(E)(0, 0), (hooke.lambda() + 2 * hooke.mu()) * e, round_off);
        EXPECT_NEAR(material.pk2(E)(1, 1), hooke.lambda() * e, round_off);
    }
}

TEST(NeoHookean, HasTheClosedFormulaOfUniaxialStrain) {
    const NeoHookean material(hooke);
    for (const double stretch : {0.3, 1.0, 2.5}) {
        const Mat3 F = Vec3(stretch, 1, 1).asDiagonal(), E = strain_of(F);
        const Mat3 cauchy = F * material.pk2(E) * F.transpose() / stretch;
        const double axial = (hooke.mu() * (stretch * stretch - 1) + hooke.lambda() * std::log(stretch)) / stretch;
        EXPECT_NEAR(cauchy(0, 0), axial, 10 * round_off) << stretch;
        EXPECT_NEAR(cauchy(1, 1), hooke.lambda() * std::log(stretch) / stretch, 10 * round_off) << stretch;
    }
}

TEST(NeoHookean, ResistsFlatteningWithoutBound) {
    const NeoHookean material(hooke);
    double last = 0;
    for (const double stretch : {1e-1, 1e-3, 1e-6}) {
        const double energy = material.energy(strain_of(Mat3(Vec3(stretch, 1, 1).asDiagonal())));
        EXPECT_GT(energy, last + 1);
        last = energy;
    }
}

} // namespace
} // namespace osculate::material::OSCULATE_THIS_FILE
