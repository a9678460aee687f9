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

/// Newton iteration of eq (25) with K_ab = X,a . X,b - (s - X) . X,ab, falling back to the metric X,a . X,b where K is not
/// positive definite; a step is at most one node distance long.                                    [Qian 2014, eq (25)]
/// @returns nothing when it does not converge: s is then near a centre of curvature or far off the patch.
template <class Patch>
[[nodiscard]] std::optional<Foot> project(const Patch& patch, const MatrixX3& coefficients, const Vec3& s, Vec2 u) {
    constexpr int most_iterations = 30;
    constexpr double tolerance = 1e-11; // of the node distance; 1e-13 would stall at round-off
    const double distance = patch.node_distance();
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
        const PatchPoint p = patch.point(u, coefficients);
        const Vec3 d = s - p.X;
        const Vec2 H = p.X_a.transpose() * d;
        const Mat2 metric = p.X_a.transpose() * p.X_a;
        Mat2 K = metric - p.curvature(d);
        if (!(K.determinant() > 0 && K.trace() > 0)) K = metric;
        Vec2 step = K.inverse() * H;
        const double length = step.norm();
        if (!std::isfinite(length)) return std::nullopt;
        if (length > distance) step *= distance / length;
        u += step;
        if (length <= tolerance * distance) return Foot{u, patch.point(u, coefficients)};
    }
    return std::nullopt;
}

/// Fills everything of `point` but facet and nodes. With K_ab = X,a . X,b - g n . X,ab and a^ab the inverse metric:
///     du_a = K^-1_ab ( X,b . (ds - Phi_i dx_i) + g n . Phi_i,b dx_i )
///     dg   = n . (ds - Phi_i dx_i)
///     dn   = -X,b a^ab ( n . Phi_i,a dx_i + n . X,ac du_c )
/// @returns false where s lies beyond 0.8 of the smallest radius of curvature on the hollow side: no unique foot.
template <class Patch>
[[nodiscard]] bool vary(const Patch& patch, const Foot& foot, const Vec3& s, ContactPoint& point) {
    const Index n = patch.size(), columns = 3 + 3 * n;
    const PatchPoint& p = foot.point;
    point.foot = p.X;
    point.normal = p.normal();
    point.gap = point.normal.dot(s - p.X);
    const Vec3& normal = point.normal;
    const double g = point.gap;

    const Mat2 metric = p.X_a.transpose() * p.X_a;
    const Mat2 inverse_metric = metric.inverse();
    const Mat2 b = p.curvature(normal);
    constexpr double largest_turn = 0.8;
    // principal curvatures are the eigenvalues of a^-1 b; the foot is unique while g * curvature stays below one
    const Mat2 shape = inverse_metric * b;
    const double mean = 0.5 * shape.trace();
    const double root = std::sqrt(std::max(0.0, mean * mean - shape.determinant()));
    if (std::max(g * (mean + root), g * (mean - root)) > largest_turn) return false;

    point.weights.resize(n);
    point.weight_gradient.resize(n, 2);
    patch.weights(foot.u, point.weights, point.weight_gradient);
    point.du.resize(2, columns);
    point.dn.resize(3, columns);
    point.dg.resize(columns);

    const Mat2 K_inverse = (metric - g * b).inverse();
    const Eigen::Matrix<double, 2, 3> tangents = p.X_a.transpose();
    const Eigen::Matrix<double, 3, 2> dual = p.X_a * inverse_metric; // X,b a^ab
    point.du.template leftCols<3>() = K_inverse * tangents;
    point.dg.template leftCols<3>() = normal.transpose();
    for (Index i = 0; i < n; ++i) {
        const double phi = point.weights(i);
        const Vec2 phi_a = point.weight_gradient.row(i).transpose();
        point.du.template middleCols<3>(3 + 3 * i) = K_inverse * (-phi * tangents + g * phi_a * normal.transpose());
        point.dg.template middleCols<3>(3 + 3 * i) = -phi * normal.transpose();
    }
    point.dn.noalias() = -dual * b * point.du;
    for (Index i = 0; i < n; ++i)
        point.dn.template middleCols<3>(3 + 3 * i) -=
            dual * point.weight_gradient.row(i).transpose() * normal.transpose();
    return true;
}

} // namespace osculate::contact
