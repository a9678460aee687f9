#include "osculate/model/rotation.hpp"

#include <cmath>
#include <numbers>

namespace osculate::model {

namespace {
constexpr double small = 1e-3; ///< rad, below which series are exact to the last digit
}

Mat3 cross_matrix(const Vec3& v) {
    Mat3 m;
    m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
    return m;
}

Quaternion turned(const Quaternion& q, const Vec3& theta) {
    const double t = theta.norm(), h = t / 2;
    const double s = t < small ? 0.5 - t * t / 48 : std::sin(h) / t;
    const Vec3 v = s * theta;
    return (Quaternion(std::cos(h), v.x(), v.y(), v.z()) * q).normalized();
}

Vec3 turned_by(const Quaternion& q, const Vec3& v) {
    // R - I = 2 (w [q] + [q]^2)
    const Vec3 once = q.vec().cross(v);
    return 2 * (q.w() * once + q.vec().cross(once));
}

Vec3 cayley(const Vec3& theta) {
    const double t = theta.norm();
    return (t < small ? 1 + t * t / 12 : std::tan(t / 2) / (t / 2)) * theta;
}

Mat3 cayley_derivative(const Vec3& theta) {
    // c = s theta: dc/dtheta = s I + (s'/t) theta theta^T, s'/t = (1/cos^2(t/2) - s)/t^2
    const double t = theta.norm(), tangent = std::tan(t / 2);
    const double s = t < small ? 1 + t * t / 12 : tangent / (t / 2);
    const double slope = t < small ? 1. / 6 + t * t / 30 : (1 + tangent * tangent - s) / (t * t);
    return s * Mat3::Identity() + slope * theta * theta.transpose();
}

Mat3 tangent_map(const Vec3& theta) {
    // T = I + (1 - cos t)/t^2 [theta] + (t - sin t)/t^3 [theta]^2
    const double t = theta.norm();
    const double a = t < small ? 0.5 - t * t / 24 : (1 - std::cos(t)) / (t * t);
    const double b = t < small ? 1. / 6 - t * t / 120 : (t - std::sin(t)) / (t * t * t);
    const Mat3 once = cross_matrix(theta);
    return Mat3::Identity() + a * once + b * once * once;
}

Vec3 rotation_vector(const Quaternion& q, const Vec3& near) {
    const double sine = q.vec().norm();
    constexpr double turn = 2 * std::numbers::pi;
    constexpr double no_axis = 1e-8; // round-off would turn it
    Vec3 axis;
    if (sine < no_axis && near.norm() > 1)
        axis = near.normalized();
    else if (sine > 0)
        axis = q.vec() / sine;
    else
        return Vec3::Zero();
    const double angle = 2 * std::atan2(q.vec().dot(axis), q.w());
    return (angle + turn * std::round((near.dot(axis) - angle) / turn)) * axis;
}

} // namespace osculate::model
