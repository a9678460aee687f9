#pragma once
/// Closest-point projection on a parametric patch and its first variation.

#include "osculate/contact/contact_point.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <optional>

namespace osculate::contact {

/// Foot of the perpendicular from s: (s - X) . X,a = 0.
struct Foot {
    Vec2 u = Vec2::Zero();
    PatchPoint point;
};

/// Newton iteration of eq (25) with K_ab = X,a . X,b - (s - X) . X,ab; uses the metric X,a . X,b if K is not positive
/// definite. A step is at most one node distance long. Ends after the step that follows one below 1e-6 node distances:
/// with quadratic convergence that is far below 1e-11, which is checked.                           [Qian 2014, eq (25)]
/// @param hopeless  hopeless(u, step) after each step that was not shortened: true ends the iteration without a foot
/// @returns no value without convergence: s is then near a centre of curvature or far off the patch.
template <class Patch, class Hopeless>
[[nodiscard]] std::optional<Foot> project(const Patch& patch, const MatrixX3& coefficients, const Vec3& s, Vec2 u,
                                          const Hopeless& hopeless) {
    constexpr int most_iterations = 30;
    constexpr double nearly = 1e-6, tolerance = 1e-11; // of the node distance; 1e-13 would stall at round-off
    const double distance = patch.node_distance();
    bool last = false;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
        PatchPoint p = patch.point(u, coefficients);
        const Vec3 d = s - p.X;
        const Vec2 H = p.X_a.transpose() * d;
        const Mat2 metric = p.X_a.transpose() * p.X_a;
        Mat2 K = metric - p.curvature(d);
        if (!(K.determinant() > 0 && K.trace() > 0)) K = metric;
        if (K.determinant() == 0) return std::nullopt;
        Vec2 step = K.inverse() * H;
        const double length = step.norm();
        if (!std::isfinite(length)) return std::nullopt;
        if (length <= (last ? tolerance * 1e2 : tolerance) * distance) { // the rest is linear to the last digit
            p.X += p.X_a * step;
            p.X_a.col(0) += step.x() * p.X_11 + step.y() * p.X_12;
            p.X_a.col(1) += step.x() * p.X_12 + step.y() * p.X_22;
            return Foot{u + step, p};
        }
        if (length > distance) step *= distance / length;
        u += step;
        last = length <= nearly * distance;
        if (length <= distance && hopeless(u, step)) return std::nullopt;
    }
    return std::nullopt;
}
template <class Patch>
[[nodiscard]] std::optional<Foot> project(const Patch& patch, const MatrixX3& coefficients, const Vec3& s, Vec2 u) {
    return project(patch, coefficients, s, u, [](const Vec2&, const Vec2&) { return false; });
}

/// Whether the foot with normal n and gap g is unique: g times the largest principal curvature is at most 0.8.
[[nodiscard]] inline bool unique(const PatchPoint& p, const Vec3& n, double g) {
    // principal curvatures are the eigenvalues of a^-1 b; the foot is unique while g * curvature stays below one
    constexpr double largest_turn = 0.8;
    const Mat2 shape = (p.X_a.transpose() * p.X_a).inverse() * p.curvature(n);
    const double mean = 0.5 * shape.trace();
    const double root = std::sqrt(std::max(0.0, mean * mean - shape.determinant()));
    return std::max(g * (mean + root), g * (mean - root)) <= largest_turn;
}

/// Gap, normal, foot and weights of `point` from the foot of s; p_i = -Phi_i n.
/// @returns false if s is beyond 0.8 of the smallest radius of curvature on the concave side: no unique foot.
template <class Patch>
[[nodiscard]] bool locate(const Patch& patch, const Foot& foot, const Vec3& s, ContactPoint& point) {
    const PatchPoint& p = foot.point;
    point.foot = p.X;
    point.normal = p.normal();
    point.gap = point.normal.dot(s - p.X);
    if (!unique(p, point.normal, point.gap)) return false;
    point.weights.resize(patch.size());
    MatrixX2 phi_a(patch.size(), 2);
    patch.weights(foot.u, point.weights, phi_a);
    point.pressing = -point.weights * point.normal.transpose();
    return true;
}

/// Variations at a point that locate() has filled. With K_ab = X,a . X,b - g n . X,ab and a^ab the inverse metric:
///     du_a = K^-1_ab ( X,b . (ds - Phi_i dx_i) + g n . Phi_i,b dx_i )
///     dg   = n . (ds - Phi_i dx_i)
///     dn   = -X,b a^ab ( n . Phi_i,a dx_i + n . X,ac du_c )
///     dPhi_i = Phi_i,a du_a,   dp_i = -n dPhi_i - Phi_i dn
template <class Patch>
void vary(const Patch& patch, const Foot& foot, const ContactPoint& point, ContactVariation& variation) {
    const Index n = patch.size(), columns = 3 + 3 * n;
    const PatchPoint& p = foot.point;
    const Vec3& normal = point.normal;
    const double g = point.gap;
    Vector phi(n);
    MatrixX2 phi_a(n, 2);
    patch.weights(foot.u, phi, phi_a);

    const Mat2 metric = p.X_a.transpose() * p.X_a;
    const Mat2 b = p.curvature(normal);
    const Mat2 K_inverse = (metric - g * b).inverse();
    const Eigen::Matrix<double, 2, 3> tangents = p.X_a.transpose();
    const Eigen::Matrix<double, 3, 2> dual = p.X_a * metric.inverse(); // X,b a^ab
    Eigen::Matrix<double, 2, Eigen::Dynamic> du(2, columns);
    variation.dg.resize(columns);
    du.template leftCols<3>() = K_inverse * tangents;
    variation.dg.template leftCols<3>() = normal.transpose();
    for (Index i = 0; i < n; ++i) {
        du.template middleCols<3>(3 + 3 * i) =
            K_inverse * (-phi(i) * tangents + g * phi_a.row(i).transpose() * normal.transpose());
        variation.dg.template middleCols<3>(3 + 3 * i) = -phi(i) * normal.transpose();
    }
    variation.dn.noalias() = -dual * b * du;
    for (Index i = 0; i < n; ++i)
        variation.dn.template middleCols<3>(3 + 3 * i) -= dual * phi_a.row(i).transpose() * normal.transpose();
    variation.dweights.noalias() = phi_a * du;
    variation.dpressing.resize(3 * n, columns);
    for (Index i = 0; i < n; ++i)
        variation.dpressing.template middleRows<3>(3 * i) = -normal * variation.dweights.row(i) - phi(i) * variation.dn;
}

} // namespace osculate::contact
