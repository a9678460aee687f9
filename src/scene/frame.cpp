#include "scene/frame.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace osculate::scene {

namespace {

constexpr double round_off = 4e-15;    ///< more than normalising leaves, so that it need not be done twice
constexpr double parallel_sine = 1e-6; ///< directions closer than this fix no plane

Vec3 unit(const Vec3& v) {
    if (std::abs(v.squaredNorm() - 1) <= round_off) return v;
    const Vec3 scaled = v / v.cwiseAbs().maxCoeff(); // no overflow in the norm
    return scaled / scaled.norm();
}

} // namespace

std::optional<Mat3> frame_of(const Vec3& a, const Vec3& b) {
    Mat3 frame;
    frame.col(0) = unit(a);
    Vec3 second = unit(b);
    if (frame.col(0).cross(second).norm() < parallel_sine) return std::nullopt;
    for (int pass = 0; pass < 3 && std::abs(frame.col(0).dot(second)) > round_off; ++pass)
        second = unit(second - frame.col(0).dot(second) * frame.col(0));
    frame.col(1) = second;
    frame.col(2) = frame.col(0).cross(second);
    return frame;
}

Mat3 frame_about(const Vec3& normal) {
    Vec3 helper = Vec3::Zero(); // the coordinate axis farthest from the normal
    Eigen::Index axis = 0;
    normal.cwiseAbs().minCoeff(&axis);
    helper[axis] = 1;
    return frame_of(normal, helper).value();
}

} // namespace osculate::scene
