#pragma once
/// Small linear algebra shared by every module: fixed-size Eigen types and the index type.

#include <Eigen/Core>
#include <Eigen/Geometry> // cross products
#include <cstdint>

namespace osculate {

using Index = std::int32_t; ///< node, element, facet and degree-of-freedom numbers

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Vec6 = Eigen::Matrix<double, 6, 1>; ///< Voigt order xx, yy, zz, xy, yz, zx
using Mat2 = Eigen::Matrix2d;
using Mat3 = Eigen::Matrix3d;
using Mat6 = Eigen::Matrix<double, 6, 6>;
using Vector = Eigen::VectorXd;
using Matrix = Eigen::MatrixXd;
using ConstVectorRef = Eigen::Ref<const Vector>; ///< read access to a vector, whatever object stores it
using VectorRef = Eigen::Ref<Vector>;            ///< write access

} // namespace osculate
