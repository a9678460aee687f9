#pragma once
/// Exact shapes of rigid surfaces: signed distance, normal and curvature by closed formulas.

#include "osculate/core/types.hpp"

#include <variant>
#include <vector>

namespace osculate::contact {

/// All lengths in m; directions are unit vectors. A shape bounds a solid, and its normals point out of this.
struct PlaneShape {
    Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ();
};
/// Without ends. inside: the solid is around the cylinder, and slaves are in it.
struct CylinderShape {
    Vec3 point = Vec3::Zero(), axis = Vec3::UnitZ();
    double radius = 1;
    bool inside = false;
};
struct SphereShape {
    Vec3 centre = Vec3::Zero();
    double radius = 1;
    bool inside = false;
};
/// One nappe without an end; the axis points from the apex into it.
struct ConeShape {
    Vec3 apex = Vec3::Zero(), axis = Vec3::UnitZ();
    double half_angle = 0.5; ///< rad, in (0, pi/2)
    bool inside = false;
};

/// A piece of a plane curve: a line, or an arc of less than half a circle. The solid is on its right, from begin to end.
struct ProfilePiece {
    Vec2 begin = Vec2::Zero(), end = Vec2::Zero();
    double bend = 0;            ///< 1/radius of an arc, > 0 where it turns left, round a hollow of the solid; 0: a line
    Vec2 centre = Vec2::Zero(); ///< of an arc
};
/// A curve moved along a direction without end; nothing is beyond the curve's own ends.
struct ExtrudedShape {
    Vec3 origin = Vec3::Zero(), along = Vec3::UnitZ();
    Vec3 u = Vec3::UnitX(), v = Vec3::UnitY(); ///< axes of the curve's plane; u, v, along are right-handed
    std::vector<ProfilePiece> pieces;          ///< each begins where the one before ends
    bool closed = false;
};

using ExactShape = std::variant<PlaneShape, CylinderShape, SphereShape, ConeShape, ExtrudedShape>;

/// What one evaluation of a shape gives.
struct ShapePoint {
    bool found = false;         ///< false: beyond the ends of a curve, or as near to many points; the rest is undefined
    double gap = 0;             ///< signed distance, > 0 outside the solid, m
    Vec3 normal = Vec3::Zero(); ///< its gradient, out of the solid
    Mat3 curvature = Mat3::Zero(); ///< its Hessian, 1/m: the change of the normal when the point moves
};
using PrecisePoint = Eigen::Matrix<long double, 3, 1>;
/// Signed distance of a point to a shape with its first and second derivatives.
[[nodiscard]] ShapePoint evaluate_precisely(const ExactShape& shape, const PrecisePoint& point);
[[nodiscard]] inline ShapePoint evaluate(const ExactShape& shape, const Vec3& point) {
    return evaluate_precisely(shape, PrecisePoint(point.cast<long double>()));
}

/// Curve through points: lines, whose inner corners are rounded with a radius; or, smooth, pairs of arcs with one tangent
/// at every point, that of the circle through it and its neighbours.                                   [Bolton 1975]
/// @param points  two or more, no two in a row the same; the first again at the end: a closed curve
/// @param fillet  m; 0: sharp corners
/// @throws std::invalid_argument in words, if a fillet is longer than a line, or the curve turns back
[[nodiscard]] std::vector<ProfilePiece> line_profile(const std::vector<Vec2>& points, double fillet);
[[nodiscard]] std::vector<ProfilePiece> smooth_profile(const std::vector<Vec2>& points);

} // namespace osculate::contact
