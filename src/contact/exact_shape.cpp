#include "osculate/contact/exact_shape.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <limits>

namespace osculate::contact {

namespace {

/// Gaps are differences of lengths that are much larger: their round-off decides how far Newton's method converges.
using Real = long double;
using V2 = Eigen::Matrix<Real, 2, 1>;
using V3 = Eigen::Matrix<Real, 3, 1>;
using M3 = Eigen::Matrix<Real, 3, 3>;

/// ShapePoint with all digits.
struct Evaluated {
    bool found = false;
    Real gap = 0;
    V3 normal = V3::Zero();
    M3 curvature = M3::Zero();
};

V3 precise(const Vec3& v) {
    return v.cast<Real>();
}
V2 precise(const Vec2& v) {
    return v.cast<Real>();
}

constexpr Real round_off = 1e-12; ///< of a radius or length: nearer to a centre or an axis there is no normal

Evaluated at(const PlaneShape& plane, const V3& p) {
    const V3 n = precise(plane.normal);
    return {true, n.dot(p - precise(plane.point)), n, M3::Zero()};
}

/// A solid around what the other one fills.
Evaluated turned_inside_out(Evaluated point, bool inside) {
    if (!inside) return point;
    point.gap = -point.gap;
    point.normal = -point.normal;
    point.curvature = -point.curvature;
    return point;
}

/// Distance r = |arm| from an axis or a centre, with gradient n = arm/r and Hessian (P - n n^T)/r, P the projector that
/// made the arm.
Evaluated from_centre(const V3& arm, const M3& P, Real radius) {
    const Real r = arm.norm();
    if (!(r > round_off * radius)) return {};
    const V3 n = arm / r;
    return {true, r - radius, n, (P - n * n.transpose()) / r};
}

Evaluated at(const CylinderShape& cylinder, const V3& p) {
    const V3 axis = precise(cylinder.axis);
    const M3 P = M3::Identity() - axis * axis.transpose();
    return turned_inside_out(from_centre(P * (p - precise(cylinder.point)), P, cylinder.radius), cylinder.inside);
}

Evaluated at(const SphereShape& sphere, const V3& p) {
    return turned_inside_out(from_centre(p - precise(sphere.centre), M3::Identity(), sphere.radius), sphere.inside);
}

Evaluated at(const ConeShape& cone, const V3& p) {
    const V3 d = p - precise(cone.apex), axis = precise(cone.axis);
    const Real z = d.dot(axis), c = std::cos(cone.half_angle), s = std::sin(cone.half_angle);
    const V3 across = d - z * axis;
    const Real r = across.norm();
    if (r * s + z * c <= 0) // nearest to the apex, outside the cone
        return turned_inside_out(from_centre(d, M3::Identity(), 0), cone.inside);
    if (!(r > round_off * d.norm())) return {};
    const V3 e = across / r, n = c * e - s * axis, t = axis.cross(e);
    return turned_inside_out({true, c * r - s * z, n, c / r * t * t.transpose()}, cone.inside);
}

/// Nearest point of a plane curve.
struct PlanePoint {
    Real distance = std::numeric_limits<Real>::infinity(); ///< > 0 outside the solid
    V2 normal = V2::Zero();
    Real curvature = 0;  ///< of the distance, across the normal, 1/m
    bool beyond = false; ///< past the ends of the curve
};

V2 left_of(const V2& t) {
    return {-t.y(), t.x()};
}

Real cross(const V2& a, const V2& b) {
    return a.x() * b.y() - a.y() * b.x();
}

/// Whether the nearest point of a line or arc is between its ends; then that point.
bool between_ends(const ProfilePiece& piece, const V2& p, PlanePoint& found) {
    if (piece.bend == 0) {
        const V2 line = precise(Vec2(piece.end - piece.begin)), t = line.normalized(), from = p - precise(piece.begin);
        const Real along = t.dot(from), length = line.norm(), slack = round_off * length;
        if (along < -slack || along > length + slack) return false;
        found.normal = left_of(t);
        found.distance = found.normal.dot(from);
        found.curvature = 0;
        return true;
    }
    const V2 centre = precise(piece.centre), arm = p - centre;
    const Real r = arm.norm(), sign = piece.bend > 0 ? -1 : 1, radius = 1 / std::abs(piece.bend);
    // the sector of the arc, which is less than half a circle
    const Real turn = piece.bend > 0 ? 1 : -1, slack = round_off * r * radius;
    if (turn * cross(precise(piece.begin) - centre, arm) < -slack ||
        turn * cross(arm, precise(piece.end) - centre) < -slack)
        return false;
    if (!(r > round_off * radius)) return false;
    // turning left, the left side is that of the centre
    found.normal = sign * arm / r;
    found.distance = sign * (r - radius);
    found.curvature = sign / r;
    return true;
}

V2 tangent(const ProfilePiece& piece, bool at_end) {
    if (piece.bend == 0) return precise(Vec2(piece.end - piece.begin)).normalized();
    const V2 arm = precise(Vec2((at_end ? piece.end : piece.begin) - piece.centre)).normalized();
    return piece.bend > 0 ? left_of(arm) : V2(-left_of(arm));
}

Evaluated at(const ExtrudedShape& shape, const V3& point) {
    const V3 d = point - precise(shape.origin), u = precise(shape.u), v = precise(shape.v);
    const V2 p(u.dot(d), v.dot(d));
    PlanePoint nearest;
    const auto take = [&](const PlanePoint& one) {
        if (std::abs(one.distance) < std::abs(nearest.distance)) nearest = one;
    };
    const std::size_t n = shape.pieces.size();
    for (std::size_t k = 0; k < n; ++k) {
        PlanePoint one;
        if (between_ends(shape.pieces[k], p, one)) take(one);
    }
    for (std::size_t k = 0; k <= n; ++k) { // corners and ends; where tangents agree, one of the two pieces is as near
        if (shape.closed && k == n) break;
        const bool end = !shape.closed && (k == 0 || k == n);
        const V2 corner = precise(k < n ? shape.pieces[k].begin : shape.pieces[n - 1].end);
        const V2 arm = p - corner;
        const Real r = arm.norm();
        if (!(r < std::abs(nearest.distance))) continue;
        if (end) {
            const V2 t = k == 0 ? V2(-tangent(shape.pieces[0], false)) : tangent(shape.pieces[n - 1], true);
            if (t.dot(arm) > 0) {
                nearest = {};
                nearest.distance = r;
                nearest.beyond = true;
            }
            continue;
        }
        const V2 before = tangent(shape.pieces[(k + n - 1) % n], true), after = tangent(shape.pieces[k], false);
        // the solid is on the right: a corner that sticks out turns right
        constexpr Real smooth = 1e-9; // rad
        const Real turn = cross(before, after);
        if (std::abs(turn) < smooth || r == 0) continue;
        const Real sign = turn < 0 ? 1 : -1;
        take({sign * r, sign * arm / r, sign / r, false});
    }
    if (nearest.beyond || !std::isfinite(nearest.distance)) return {};
    const auto in_space = [&](const V2& a) { return V3(a.x() * u + a.y() * v); };
    const V3 t = in_space(left_of(nearest.normal));
    return {true, nearest.distance, in_space(nearest.normal), nearest.curvature * t * t.transpose()};
}

} // namespace

ShapePoint evaluate_precisely(const ExactShape& shape, const PrecisePoint& point) {
    const Evaluated found = std::visit([&](const auto& one) { return at(one, point); }, shape);
    return {found.found, static_cast<double>(found.gap), found.normal.cast<double>(), found.curvature.cast<double>()};
}

} // namespace osculate::contact
