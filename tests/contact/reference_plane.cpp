#include "osculate/contact/rpim_patch.hpp"
#include "support/random.hpp"

#include <gtest/gtest.h>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

constexpr double round_off = 1e-14; // a dozen products of numbers of order one

std::vector<Vec3> normals() {
    std::vector<Vec3> all{Vec3::UnitZ(), -Vec3::UnitZ(), Vec3::UnitX(), -Vec3::UnitX(), Vec3::UnitY(), -Vec3::UnitY()};
    for (const double n3 :
         {-1e-16, -1e-9, -1e-3, 1e-16, 1e-9}) // either side of the equator, where the formula is mirrored
        for (const double angle : {0.0, 0.7, 2.0, 4.5})
            all.push_back(Vec3(std::cos(angle), std::sin(angle), n3).normalized());
    for (const double tilt : {1e-9, 1e-6}) { // next to the poles, where eq. (20) has its 0/0
        all.push_back(Vec3(tilt, -tilt, 1).normalized());
        all.push_back(Vec3(tilt, -tilt, -1).normalized());
    }
    osculate::support::Random random(1);
    for (int i = 0; i < 200; ++i) all.push_back(random.direction());
    return all;
}

TEST(ReferencePlane, HasRightHandedOrthonormalAxesForEveryNormal) {
    for (const Vec3& n : normals()) {
        const ReferencePlane plane = ReferencePlane::through(Vec3(1, 2, 3), n);
        const Vec3 e1 = plane.axes.col(0), e2 = plane.axes.col(1);
        EXPECT_NEAR(e1.norm(), 1, round_off) << n.transpose();
        EXPECT_NEAR(e2.norm(), 1, round_off) << n.transpose();
        EXPECT_NEAR(e1.dot(e2), 0, round_off) << n.transpose();
        EXPECT_LT((e1.cross(e2) - n).norm(), round_off) << n.transpose();
    }
}

TEST(ReferencePlane, IsTurnedByTheShortestRotationInTheUpperHalf) {
    for (const Vec3& n : normals()) {
        if (n.z() < 0) continue;
        const Mat3 turn = Eigen::Quaterniond::FromTwoVectors(Vec3::UnitZ(), n).toRotationMatrix();
        const ReferencePlane plane = ReferencePlane::through(Vec3::Zero(), n);
        const double quaternion_round_off = 1e-8; // Eigen's quaternion loses half the digits of nearly parallel vectors
        EXPECT_LT((plane.axes - turn.leftCols<2>()).norm(), quaternion_round_off) << n.transpose();
    }
}

TEST(ReferencePlane, ProjectsTangentiallyAndOverItsNormal) {
    const Vec3 origin(1, -2, 0.5), n = Vec3(1, 2, 2) / 3;
    const ReferencePlane plane = ReferencePlane::through(origin, n);
    const Vec2 u(0.3, -0.7);
    const Vec3 x = origin + plane.axes * u + 0.4 * n;
    EXPECT_LT((plane.tangential(x) - u).norm(), round_off);
}

TEST(ReferencePlane, KeepsDirectionAndTrueLengthInEqualLengthCoordinates) {
    const Vec3 origin(1, -2, 0.5), n = Vec3(1, 2, 2) / 3;
    const ReferencePlane plane = ReferencePlane::through(origin, n);
    const Vec2 direction = Vec2(3, -4) / 5;
    const Vec3 x = origin + plane.axes * (0.3 * direction) + 0.4 * n;
    EXPECT_LT((plane.equal_length(x) - 0.5 * direction).norm(), round_off); // 0.3, 0.4, 0.5
    EXPECT_EQ(plane.equal_length(origin), Vec2(0, 0));
}

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
