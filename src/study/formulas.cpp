#include "osculate/study/formulas.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace osculate::study {

namespace {

using std::numbers::pi;

constexpr const char* johnson = "Johnson, Contact Mechanics (1985)";

double cube_root_radius(double F, double R, double Es) {
    return std::cbrt(3 * F * R / (4 * Es));
}
double half_width(double P, double R, double Es) {
    return std::sqrt(4 * P * R / (pi * Es));
}
double positive_root(double x) {
    return std::sqrt(std::max(0.0, x));
}
double impact_approach(double m, double v, double R, double Es) {
    return std::pow(15 * m * v * v / (16 * Es * std::sqrt(R)), 0.4);
}
double impedance(double E, double rho) {
    return std::sqrt(E * rho);
}

/// Time of the bouncing rod's period of 3, of which the second half mirrors the first.
double folded(double t) {
    t = std::fmod(t, 3);
    return t > 1.5 ? 3 - t : t;
}

double rod_displacement(double x, double t) {
    t = folded(t);
    return t < 1 ? 0.5 * (1 - std::max(x, t)) : -0.5 * std::min({t - 1, x, 1 - x});
}

double oscillator(double t, double omega, double zeta, double u0, double v0) {
    const double damped = omega * std::sqrt(1 - zeta * zeta);
    return std::exp(-zeta * omega * t) *
           (u0 * std::cos(damped * t) + (v0 + zeta * omega * u0) / damped * std::sin(damped * t));
}

constexpr NamedSolution table[] = {
    {"effective_modulus", "E1, nu1, E2, nu2", 4,
     [](const double* a) { return 1 / ((1 - a[1] * a[1]) / a[0] + (1 - a[3] * a[3]) / a[2]); }, "E* of two bodies",
     johnson},
    {"effective_radius", "R1, R2", 2, [](const double* a) { return 1 / (1 / a[0] + 1 / a[1]); },
     "R of two balls or cylinders", johnson},
    {"hertz_sphere_radius", "F, R, Es", 3, [](const double* a) { return cube_root_radius(a[0], a[1], a[2]); },
     "radius of the contact", johnson},
    {"hertz_sphere_peak_pressure", "F, R, Es", 3,
     [](const double* a) { return 3 * a[0] / (2 * pi * std::pow(cube_root_radius(a[0], a[1], a[2]), 2)); },
     "pressure at its centre", johnson},
    {"hertz_sphere_pressure", "r, F, R, Es", 4,
     [](const double* a) {
         const double c = cube_root_radius(a[1], a[2], a[3]);
         return 3 * a[1] / (2 * pi * c * c) * positive_root(1 - a[0] * a[0] / (c * c));
     },
     "pressure at the distance r from its centre", johnson},
    {"hertz_sphere_approach", "F, R, Es", 3,
     [](const double* a) { return std::pow(cube_root_radius(a[0], a[1], a[2]), 2) / a[1]; },
     "approach of distant points", johnson},
    {"hertz_sphere_force", "d, R, Es", 3,
     [](const double* a) { return 4.0 / 3 * a[2] * std::sqrt(a[1]) * std::pow(a[0], 1.5); }, "force of an approach d",
     johnson},
    {"hertz_cylinder_half_width", "P, R, Es", 3, [](const double* a) { return half_width(a[0], a[1], a[2]); },
     "half-width of the strip; P is the force per length", johnson},
    {"hertz_cylinder_peak_pressure", "P, R, Es", 3,
     [](const double* a) { return 2 * a[0] / (pi * half_width(a[0], a[1], a[2])); }, "pressure at its middle", johnson},
    {"hertz_cylinder_pressure", "x, P, R, Es", 4,
     [](const double* a) {
         const double b = half_width(a[1], a[2], a[3]);
         return 2 * a[1] / (pi * b) * positive_root(1 - a[0] * a[0] / (b * b));
     },
     "pressure at the distance x from its middle", johnson},
    {"hertz_cylinder_approach", "P, R, b, E, nu", 5,
     [](const double* a) { return a[0] * (1 - a[4] * a[4]) / (pi * a[3]) * (2 * std::log(4 * a[1] / a[2]) - 1); },
     "of the centre of a cylinder of radius R and the contact, of half-width b, one body's share", johnson},
    {"hertz_cylinder_force", "b, R, Es", 3, [](const double* a) { return pi * a[0] * a[0] * a[2] / (4 * a[1]); },
     "force per length of a half-width b", johnson},
    {"cattaneo_mindlin_stick_half_width", "b, Q, mu, P", 4,
     [](const double* a) { return a[0] * positive_root(1 - a[1] / (a[2] * a[3])); },
     "of a cylinder pressed by P, then pushed by Q < mu P; b is the half-width of the contact",
     "Cattaneo (1938), Mindlin (1949)"},
    {"cattaneo_mindlin_traction", "x, b, Q, mu, P", 5,
     [](const double* a) {
         const double c2 = a[1] * a[1] * (1 - a[2] / (a[3] * a[4])), x2 = a[0] * a[0];
         return 2 * a[3] * a[4] / (pi * a[1] * a[1]) * (positive_root(a[1] * a[1] - x2) - positive_root(c2 - x2));
     },
     "shear traction at the distance x from the middle", "Cattaneo (1938), Mindlin (1949)"},
    {"cattaneo_mindlin_peak_traction", "b, Q, mu, P", 4,
     [](const double* a) { return 2 * a[2] * a[3] / (pi * a[0]) * std::sqrt(a[1] / (a[2] * a[3])); },
     "the largest, at the edge of the stick zone", "Cattaneo (1938), Mindlin (1949)"},
    {"cattaneo_mindlin_stick_radius", "a, Q, mu, F", 4,
     [](const double* a) { return a[0] * std::cbrt(std::max(0.0, 1 - a[1] / (a[2] * a[3]))); },
     "of a ball pressed by F, then pushed by Q < mu F; a is the radius of the contact", "Mindlin (1949)"},
    {"nested_tubes_pressure", "p, a, r, b", 4,
     [](const double* a) {
         return a[0] * a[1] * a[1] / (a[3] * a[3] - a[1] * a[1]) * (a[3] * a[3] / (a[2] * a[2]) - 1);
     },
     "between two tubes of one material with radii a < r < b under the inner pressure p", "Lame (1852)"},
    {"tube_displacement", "r, p, a, b, E, nu", 6,
     [](const double* a) {
         const double k = a[1] * a[2] * a[2] / (a[3] * a[3] - a[2] * a[2]);
         return (1 + a[5]) / a[4] * k * ((1 - 2 * a[5]) * a[0] + a[3] * a[3] / a[0]);
     },
     "radial displacement at r of a tube of radii a < b under the inner pressure p, plane strain", "Lame (1852)"},
    {"bar_interface_stress", "V, E1, rho1, E2, rho2", 5,
     [](const double* a) { return a[0] / (1 / impedance(a[1], a[2]) + 1 / impedance(a[3], a[4])); },
     "of two bars, nu = 0, that meet at the relative speed V", "d'Alembert"},
    {"bar_contact_duration", "L, E, rho", 3, [](const double* a) { return 2 * a[0] / std::sqrt(a[1] / a[2]); },
     "of two equal bars of length L, or of one on a rigid wall", "d'Alembert"},
    {"incline_acceleration", "g, slope, mu", 3,
     [](const double* a) {
         const double cosine = 1 / std::sqrt(1 + a[1] * a[1]);
         return a[1] <= a[2] ? 0 : a[0] * cosine * (a[1] - a[2]);
     },
     "of a block on a slope tan A; 0 where it sticks", "Coulomb (1785)"},
    {"hertz_impact_approach", "m, v, R, Es", 4, [](const double* a) { return impact_approach(a[0], a[1], a[2], a[3]); },
     "largest approach of two balls that meet at v; m is [1/m1 + 1/m2]^-1", "Hertz (1882)"},
    {"hertz_impact_duration", "m, v, R, Es", 4,
     [](const double* a) {
         // 4/5 B(2/5, 1/2) d/v
         return 4. / 5 * std::beta(0.4, 0.5) * impact_approach(a[0], a[1], a[2], a[3]) / a[1];
     },
     "of the contact", "Hertz (1882)"},
    {"hertz_impact_force", "m, v, R, Es", 4,
     [](const double* a) {
         return 4.0 / 3 * a[3] * std::sqrt(a[2]) * std::pow(impact_approach(a[0], a[1], a[2], a[3]), 1.5);
     },
     "the largest", "Hertz (1882)"},
    {"rod_displacement", "x, t", 2, [](const double* a) { return rod_displacement(a[0], a[1]); },
     "of a rod with L = E = rho = 1, u(x, 0) = (1 - x)/2, clamped at x = 1, stopped at x = 0", "d'Alembert"},
    {"rod_reaction", "t", 1, [](const double* a) { return folded(a[0]) > 1 ? 0.5 : 0.0; },
     "of the stop on that rod, per area", "d'Alembert"},
    {"oscillator_displacement", "t, omega, zeta, u0, v0", 5,
     [](const double* a) { return oscillator(a[0], a[1], a[2], a[3], a[4]); },
     "free vibration from u0, v0 with damping ratio zeta < 1", "Chopra, Dynamics of Structures"},
    {"fall_duration", "h, g", 2, [](const double* a) { return std::sqrt(2 * a[0] / a[1]); }, "of a fall from rest by h",
     "Galilei (1638)"},
};

} // namespace

std::span<const NamedSolution> formulas() {
    return table;
}

} // namespace osculate::study
