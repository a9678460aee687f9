#pragma once
/// Factors on the masses of a body's parts that give the body prescribed moments.

#include "osculate/core/types.hpp"

#include <optional>

namespace osculate::model {

/// Moments of a mass distribution about one point: of 1, x, y, z, xx, yy, zz, xy, yz, zx, in this order.
using Moments = Eigen::Matrix<double, 10, 1>;

/// Moments of a mass matrix: sum_ij m_ij phi(x_i, x_j), phi = 1, (x_i + x_j)/2, x_i x_j^T. They determine the momentum
/// and energy of motions that are affine in x.
/// @param mass  (n x n) kg, symmetric; diagonal if lumped
/// @param x     (3 x n) points relative to the reference point, in any unit, which may differ by axis
[[nodiscard]] Moments moments(const Matrix& mass, const Eigen::Matrix3Xd& x);

/// Factors a_p > 0 with sum_p a_p parts.col(p) = target that are nearest to 1: those of the least relative entropy
/// sum_p m_p (a_p ln a_p - a_p + 1), a_p = exp(l . parts.col(p)/m_p) with m_p = parts(0, p). Newton's method finds the
/// ten multipliers l as minimum of a convex function. All masses stay positive, and every affine motion keeps its
/// momentum and energy.                                         [conditions: Khenous, Laborde & Renard 2008, section 3]
/// @param parts   (10 x parts) moments about the target's centre, lengths divided by half the body's extents; masses >
///                0
/// @param target  moments of the whole body, in the same units
/// @returns no value if no such factors exist between exp(-10) and exp(10)
[[nodiscard]] std::optional<Vector> moment_factors(const Eigen::Matrix<double, 10, Eigen::Dynamic>& parts,
                                                   const Moments& target);

} // namespace osculate::model
