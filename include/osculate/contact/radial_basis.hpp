#pragma once
/// Radial basis functions of the squared distance rho = |t - t_i|^2 in scaled natural coordinates.

#include <cmath>

namespace osculate::contact {

/// Value and derivatives of a radial function with respect to rho.
struct RadialValue {
    double f = 0, df = 0, ddf = 0, dddf = 0;
};

/// Multiquadric (rho + R^2)^q; R = 0, q = 2.5 is the polyharmonic r^5.                       [Qian 2014, eq (10)]
struct Multiquadric {
    double R = 1.42;
    double q = 1.03;

    [[nodiscard]] RadialValue operator()(double rho) const {
        const double base = rho + R * R;
        if (base <= 0) return {}; // R = 0 at its own centre: f and rho * ddf vanish there for q > 1
        if (q == 2.5) {           // r^5, the default: a root costs less than a power
            const double root = std::sqrt(base);
            return {base * base * root, 2.5 * base * root, 3.75 * root, 1.875 / root};
        }
        const double f = std::pow(base, q);
        const double df = q * f / base;
        const double ddf = (q - 1) * df / base;
        return {f, df, ddf, (q - 2) * ddf / base};
    }
};

inline constexpr Multiquadric r3{0, 1.5}, r5{0, 2.5}; ///< polyharmonic

/// The basis for a patch whose facets turn by `angle` from one to the next, rad. r^5 has the smallest error where the
/// facets resolve the surface, and the largest where they do not (docs/verification/surface_options.md).
[[nodiscard]] constexpr const Multiquadric& basis_for(double angle) {
    constexpr double resolved = 0.35; // 20 degrees
    return angle <= resolved ? r5 : r3;
}

} // namespace osculate::contact
