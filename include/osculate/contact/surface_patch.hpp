#pragma once
/// Values shared by every parametric patch X(u) = sum_i Phi_i(u) x_i of a master surface.

#include "osculate/core/types.hpp"

namespace osculate::contact {

using Matrix32 = Eigen::Matrix<double, 3, 2>;
using MatrixX3 = Eigen::Matrix<double, Eigen::Dynamic, 3>;
using MatrixX2 = Eigen::Matrix<double, Eigen::Dynamic, 2>;

/// Position and derivatives of a patch with respect to its natural coordinates.
struct PatchPoint {
    Vec3 X = Vec3::Zero();
    Matrix32 X_a = Matrix32::Zero(); ///< columns X,1 and X,2
    Vec3 X_11 = Vec3::Zero(), X_12 = Vec3::Zero(), X_22 = Vec3::Zero();

    [[nodiscard]] Vec3 normal() const { return X_a.col(0).cross(X_a.col(1)).normalized(); }
    /// Second derivatives projected on v: entries v . X,ab.
    [[nodiscard]] Mat2 curvature(const Vec3& v) const {
        const double b12 = v.dot(X_12);
        return (Mat2() << v.dot(X_11), b12, b12, v.dot(X_22)).finished();
    }
};

/// Third derivatives of a patch.
struct PatchThird {
    Vec3 X_111 = Vec3::Zero(), X_112 = Vec3::Zero(), X_122 = Vec3::Zero(), X_222 = Vec3::Zero();
};

} // namespace osculate::contact
