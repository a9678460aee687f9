#include "osculate/material/j2_plasticity.hpp"

#include "osculate/material/voigt.hpp"
#include "support/differences.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <gtest/gtest.h>

namespace osculate::material::OSCULATE_THIS_FILE {
namespace {

const LinearElastic hooke{200.0, 0.3};
const Hardening hardening{{{0, 1}, {0.02, 1.5}, {0.1, 2}}};
const J2Plasticity law{hooke, hardening};

Mat3 strain_of(const Vec6& v) {
    Mat3 E;
    E << v[0], v[3] / 2, v[5] / 2, v[3] / 2, v[1], v[4] / 2, v[5] / 2, v[4] / 2, v[2];
    return E;
}
Mat3 of_gradient(const Mat3& F) {
    return (F.transpose() * F - Mat3::Identity()) / 2;
}
/// Large strains with distinct axes, a state that has flowed before, and strains whose eigenvalues are close or alike.
std::vector<Mat3> strains() {
    Mat3 F;
    F << 1.2, 0.3, -0.1, 0.05, 0.8, 0.2, -0.15, 0.1, 1.1;
    const Mat3 Q = Eigen::AngleAxisd(0.7, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
    std::vector<Mat3> all{of_gradient(F)};
    for (const Vec3& x :
         {Vec3(0.2, -0.1, -0.1), Vec3(0.3, 0.1, 0.1 + 1e-5), Vec3(0.05, 0.05 + 3e-4, -0.02), Vec3(0.01, 0.01, 0.01)})
        all.emplace_back(Q * x.asDiagonal() * Q.transpose());
    return all;
}
std::array<double, J2Plasticity::memory> flowed() {
    std::array<double, J2Plasticity::memory> memory{};
    Mat3 F;
    F << 1.03, 0.02, 0, 0, 0.99, 0.01, 0.01, 0, 0.98;
    law.at({}).end(of_gradient(F), memory);
    return memory;
}

TEST(J2Plasticity, StressIsTheDerivativeOfThePotentialOfAStep) {
    const auto memory = flowed();
    for (const auto& start : {law.at({}), law.at(memory)})
        for (const Mat3& E : strains()) {
            const Matrix slope = osculate::support::central_differences(
                [&](const Vector& v) { return Vector::Constant(1, start.potential(strain_of(Vec6(v)))).eval(); },
                strain_vector(E), 1e-5);
            const Vec6 S = stress_vector(start.pk2(E));
            EXPECT_LT((slope.transpose() - S).norm(), 1e-6 * (1 + S.norm()));
        }
}

TEST(J2Plasticity, TangentIsTheDerivativeOfTheStress) {
    const auto memory = flowed();
    for (const auto& start : {law.at({}), law.at(memory)})
        for (const Mat3& E : strains()) {
            const Matrix slope = osculate::support::central_differences(
                [&](const Vector& v) { return Vector(stress_vector(start.pk2(strain_of(Vec6(v))))); }, strain_vector(E),
                1e-6);
            const Mat6 D = start.tangent(E);
            EXPECT_LT((slope - D).norm(), 1e-6 * D.norm());
            EXPECT_EQ((D - D.transpose()).norm(), 0);
        }
}

TEST(J2Plasticity, IsHookesLawBelowTheYieldStress) {
    EXPECT_LT((law.at({}).tangent(Mat3::Zero()) - hooke.stiffness()).norm(), 1e-13 * hooke.stiffness().norm());
    const Mat3 E = strain_of((Vec6() << 1e-9, -2e-9, 3e-9, 1e-9, 0, 2e-9).finished());
    const Vec6 stress = hooke.stress(strain_vector(E));
    EXPECT_LT((stress_vector(law.at({}).pk2(E)) - stress).norm(), 1e-7 * stress.norm());
}

TEST(J2Plasticity, FollowsTheHardeningCurveInTension) {
    // a bar of stretches (l, w, w): no lateral stress, Kirchhoff stress y(a), logarithmic strain y/E + a
    for (const double a : {0.01, 0.02, 0.05, 0.3}) {
        const double y = hardening.yield_stress(a), e = y / hooke.E + a, lateral = -hooke.nu * y / hooke.E - a / 2;
        const Vec3 E(std::expm1(2 * e) / 2, std::expm1(2 * lateral) / 2, std::expm1(2 * lateral) / 2);
        const Mat3 S = law.at({}).pk2(E.asDiagonal());
        EXPECT_NEAR(S(0, 0) * std::exp(2 * e), y, 1e-12);
        EXPECT_NEAR(S(1, 1), 0, 1e-12);
        std::array<double, J2Plasticity::memory> memory{};
        law.at({}).end(E.asDiagonal(), memory);
        EXPECT_NEAR(J2Plasticity::plastic_strain(memory), a, 1e-13);
        EXPECT_NEAR(memory[0] + memory[1] + memory[2], 0, 1e-14) << "flow keeps the volume";
    }
}

TEST(J2Plasticity, IntegratesItsHardeningCurve) {
    EXPECT_DOUBLE_EQ(hardening.work(0.01), 0.01 * 1.125);
    EXPECT_DOUBLE_EQ(hardening.work(0.02), 0.02 * 1.25);
    EXPECT_DOUBLE_EQ(hardening.work(0.2), 0.02 * 1.25 + 0.08 * 1.75 + 0.1 * 2);
}

TEST(J2Plasticity, IsIsotropic) {
    const Mat3 Q = Eigen::AngleAxisd(0.7, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
    for (const Mat3& E : strains()) {
        const Mat3 S = law.at({}).pk2(E);
        EXPECT_LT((law.at({}).pk2(Q * E * Q.transpose()) - Q * S * Q.transpose()).norm(), 1e-12 * S.norm() + 1e-12);
    }
}

} // namespace
} // namespace osculate::material::OSCULATE_THIS_FILE
