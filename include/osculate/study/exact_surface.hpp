#pragma once
/// Surfaces in closed form, as reference for approximations through their nodes.

#include "osculate/core/types.hpp"

#include <variant>

namespace osculate::study {

/// Point of an exact surface closest to another point.
struct ExactPoint {
    Vec3 point = Vec3::Zero();
    Vec3 normal = Vec3::Zero(); ///< out of the sphere, out of the tube, upward on the saddle
    double mean_curvature = 0;  ///< H = 1/2 div n, 1/m; 1/radius on a sphere
};

struct Sphere {
    Vec3 centre = Vec3::Zero();
    double radius = 1; ///< m

    [[nodiscard]] ExactPoint closest(const Vec3& x) const;
};

/// A torus around the z axis.
struct Torus {
    Vec3 centre = Vec3::Zero();
    double ring_radius = 2; ///< of the circle at the centre of the tube, m
    double tube_radius = 1; ///< m

    [[nodiscard]] ExactPoint closest(const Vec3& x) const;
};

/// x3 = c3 + rise (x1 - c1)^2 - fall (x2 - c2)^2
struct Saddle {
    Vec3 centre = Vec3::Zero(); ///< c, m
    double rise = 1, fall = 1;  ///< 1/m

    [[nodiscard]] double height(double x1, double x2) const;
    /// By Newton's method from the point above or below x.  @pre  the distance of x is well below the radii of
    /// curvature
    [[nodiscard]] ExactPoint closest(const Vec3& x) const;
};

using ExactSurface = std::variant<Sphere, Torus, Saddle>;

} // namespace osculate::study
