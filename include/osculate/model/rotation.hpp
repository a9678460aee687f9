#pragma once
/// Finite rotations: increments as rotation vectors, orientations as quaternions.

#include "osculate/core/types.hpp"

namespace osculate::model {

using Quaternion = Eigen::Quaterniond;

/// The matrix [v] with [v] a = v x a.
[[nodiscard]] Mat3 cross_matrix(const Vec3& v);
/// exp([theta]) q, of unit length.
[[nodiscard]] Quaternion turned(const Quaternion& q, const Vec3& theta);
/// Turns v by q, minus v: without loss of digits for small rotations.
[[nodiscard]] Vec3 turned_by(const Quaternion& q, const Vec3& v);
/// Cayley's vector of a rotation vector, c = tan(t/2)/(t/2) theta with t = |theta|: positions before and after differ by
/// exactly c x (their mean).
/// @pre |theta| < pi
[[nodiscard]] Vec3 cayley(const Vec3& theta);
/// dc/dtheta.
[[nodiscard]] Mat3 cayley_derivative(const Vec3& theta);
/// The map T of dR = [T dtheta] R for R = exp([theta]).
[[nodiscard]] Mat3 tangent_map(const Vec3& theta);
/// The rotation vector of q that is nearest to `near`, of all that differ by whole turns: it is continuous beyond pi.
[[nodiscard]] Vec3 rotation_vector(const Quaternion& q, const Vec3& near);

} // namespace osculate::model
