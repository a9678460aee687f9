/// Plane curves of lines and arcs through points.

#include "osculate/contact/exact_shape.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace osculate::contact {

namespace {

Vec2 left_of(const Vec2& t) {
    return {-t.y(), t.x()};
}

std::string place(std::size_t k) {
    return "point " + std::to_string(k + 1);
}

/// The arc from begin to end with the unit tangent t at `touched`, one of the two; a line where they agree.
ProfilePiece arc(const Vec2& begin, const Vec2& end, const Vec2& touched, const Vec2& t) {
    constexpr double straight = 1e-10; // sine of the angle between chord and tangent
    const Vec2 chord = touched == begin ? Vec2(end - begin) : Vec2(begin - end);
    const double rise = chord.dot(left_of(t));
    ProfilePiece piece{begin, end};
    if (std::abs(rise) <= straight * chord.norm()) return piece;
    const double radius = chord.squaredNorm() / (2 * rise); // > 0: the centre is on the left
    piece.bend = 1 / radius;
    piece.centre = touched + radius * left_of(t);
    return piece;
}

/// Two arcs with one tangent in the middle, of as long legs at both ends.                                     [Bolton 1975]
void add_biarc(const Vec2& a, const Vec2& ta, const Vec2& b, const Vec2& tb, std::size_t k,
               std::vector<ProfilePiece>& pieces) {
    const Vec2 v = b - a, t = ta + tb;
    // v.v - 2 d v.t - 2 d^2 (1 - ta.tb) = 0
    const double vt = v.dot(t), q = 2 * (1 - ta.dot(tb)), root = std::sqrt(vt * vt + q * v.squaredNorm());
    const double leg = v.squaredNorm() / (vt + root); // the positive root, without cancelling
    if (!(vt > 0) || !std::isfinite(leg))
        throw std::invalid_argument("the curve turns by half a circle or more after " + place(k));
    const Vec2 middle = 0.5 * (a + b + leg * (ta - tb));
    for (const ProfilePiece& piece : {arc(a, middle, a, ta), arc(middle, b, b, tb)})
        if ((piece.end - piece.begin).norm() > 0) pieces.push_back(piece);
}

} // namespace

std::vector<ProfilePiece> line_profile(const std::vector<Vec2>& points, double fillet) {
    const std::size_t lines = points.size() - 1;
    const bool closed = points.front() == points.back() && lines > 2;
    std::vector<Vec2> t;
    std::vector<double> length;
    for (std::size_t k = 0; k < lines; ++k) {
        t.emplace_back((points[k + 1] - points[k]).normalized());
        length.push_back((points[k + 1] - points[k]).norm());
    }
    // legs[k]: of the fillet at point k, what it takes of both lines there
    std::vector<double> legs(points.size(), 0.0);
    const auto before = [&](std::size_t k) { return k == 0 ? lines - 1 : k - 1; };
    for (std::size_t k = closed ? 0 : 1; k < lines; ++k) {
        constexpr double back = -1 + 1e-9;
        if (t[before(k)].dot(t[k]) < back) throw std::invalid_argument("the curve turns back at " + place(k));
        const double turn =
            std::atan2(t[before(k)].x() * t[k].y() - t[before(k)].y() * t[k].x(), t[before(k)].dot(t[k]));
        legs[k] = fillet * std::tan(std::abs(turn) / 2);
    }
    if (closed) legs[lines] = legs[0];
    std::vector<ProfilePiece> pieces;
    for (std::size_t k = 0; k < lines; ++k) {
        constexpr double round_off = 1e-12;
        if (legs[k] + legs[k + 1] > (1 + round_off) * length[k])
            throw std::invalid_argument("the fillets take more than the line from " + place(k) + " to " + place(k + 1));
        const Vec2 begin = points[k] + legs[k] * t[k], end = points[k + 1] - legs[k + 1] * t[k];
        if (legs[k] > 0) pieces.push_back(arc(Vec2(points[k] - legs[k] * t[before(k)]), begin, begin, t[k]));
        if (length[k] - legs[k] - legs[k + 1] > round_off * length[k]) pieces.push_back({begin, end});
    }
    return pieces;
}

std::vector<ProfilePiece> smooth_profile(const std::vector<Vec2>& points) {
    const std::size_t n = points.size();
    const bool closed = points.front() == points.back() && n > 3;
    // of the circle through three points, in the middle one: inversion makes it a line
    const auto middle = [&](std::size_t before, std::size_t k, std::size_t after) {
        const Vec2 a = points[k] - points[before], b = points[after] - points[k];
        return Vec2((a / a.squaredNorm() + b / b.squaredNorm()).normalized());
    };
    const auto mirrored = [](const Vec2& t, const Vec2& chord) {
        const Vec2 c = chord.normalized();
        return Vec2(2 * t.dot(c) * c - t);
    };
    std::vector<Vec2> t(n, (points[1] - points[0]).normalized());
    for (std::size_t k = 1; k + 1 < n; ++k) t[k] = middle(k - 1, k, k + 1);
    if (closed) {
        t[0] = t[n - 1] = middle(n - 2, 0, 1);
    } else if (n > 2) {
        t[0] = mirrored(t[1], points[1] - points[0]);
        t[n - 1] = mirrored(t[n - 2], points[n - 1] - points[n - 2]);
    }
    std::vector<ProfilePiece> pieces;
    for (std::size_t k = 0; k + 1 < n; ++k) add_biarc(points[k], t[k], points[k + 1], t[k + 1], k, pieces);
    return pieces;
}

} // namespace osculate::contact
