#pragma once
/// Distances and crossings of a flat triangle.

#include "osculate/core/types.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace osculate::mesh {

struct Triangle {
    Vec3 a, b, c;

    /// Not normalised: twice the area long.
    [[nodiscard]] Vec3 normal() const { return (b - a).cross(c - a); }

    /// Point of the triangle that is closest to p, by the regions of Voronoi of its features.  [Ericson 2005, section 5.1.5]
    [[nodiscard]] Vec3 closest(const Vec3& p) const {
        const Vec3 ab = b - a, ac = c - a, ap = p - a;
        const double d1 = ab.dot(ap), d2 = ac.dot(ap);
        if (d1 <= 0 && d2 <= 0) return a;
        const Vec3 bp = p - b;
        const double d3 = ab.dot(bp), d4 = ac.dot(bp);
        if (d3 >= 0 && d4 <= d3) return b;
        const double vc = d1 * d4 - d3 * d2;
        if (vc <= 0 && d1 >= 0 && d3 <= 0) return d1 == d3 ? a : Vec3(a + d1 / (d1 - d3) * ab);
        const Vec3 cp = p - c;
        const double d5 = ab.dot(cp), d6 = ac.dot(cp);
        if (d6 >= 0 && d5 <= d6) return c;
        const double vb = d5 * d2 - d1 * d6;
        if (vb <= 0 && d2 >= 0 && d6 <= 0) return d2 == d6 ? a : Vec3(a + d2 / (d2 - d6) * ac);
        const double va = d3 * d6 - d5 * d4;
        if (va <= 0 && d4 - d3 >= 0 && d5 - d6 >= 0) {
            const double length = (d4 - d3) + (d5 - d6);
            return length == 0 ? b : Vec3(b + (d4 - d3) / length * (c - b));
        }
        const double sum = va + vb + vc;
        return sum == 0 ? a : Vec3(a + vb / sum * ab + vc / sum * ac);
    }

    /// Angle of the triangle around one of its own points: at a corner, to within `near` of the longest side, that of the corner,
    /// else pi.
    [[nodiscard]] double angle_at(const Vec3& p, double near) const {
        const double size2 = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
        const auto between = [](const Vec3& u, const Vec3& v) { return std::atan2(u.cross(v).norm(), u.dot(v)); };
        const auto is_at = [&](const Vec3& corner) { return (p - corner).squaredNorm() <= near * near * size2; };
        if (is_at(a)) return between(b - a, c - a);
        if (is_at(b)) return between(c - b, a - b);
        if (is_at(c)) return between(a - c, b - c);
        return std::numbers::pi;
    }

    /// Whether a point of its plane lies in it, or beside it by round-off.
    [[nodiscard]] bool holds(const Vec3& p) const {
        constexpr double round_off = 1e-9; // of the area
        const Vec3 n = normal();
        const double least = -round_off * n.squaredNorm();
        return (b - a).cross(p - a).dot(n) >= least && (c - b).cross(p - b).dot(n) >= least &&
               (a - c).cross(p - c).dot(n) >= least;
    }
};

} // namespace osculate::mesh
