#include "osculate/material/neo_hookean.hpp"

#include "osculate/material/voigt.hpp"

#include <Eigen/LU>
#include <array>
#include <cmath>

namespace osculate::material {
namespace {

/// ln J from J^2 - 1 = det(1 + A) - 1 = tr A + II_A + det A, A = 2 E: without loss of digits at small strain.
double log_volume(const Mat3& E) {
    const double trace = 2 * E.trace();
    const double second = (trace * trace - 4 * E.squaredNorm()) / 2;
    return std::log1p(trace + second + 8 * E.determinant()) / 2;
}

Mat3 inverse_of_C(const Mat3& E) {
    return (Mat3::Identity() + 2 * E).inverse();
}

} // namespace

double NeoHookean::energy(const Mat3& E) const {
    const double log_J = log_volume(E);
    return mu_ * (E.trace() - log_J) + lambda_ / 2 * log_J * log_J; // I1 - 3 = 2 tr E
}

Mat3 NeoHookean::pk2(const Mat3& E) const {
    const Mat3 inverse = inverse_of_C(E);
    return inverse * (2 * mu_ * E) + lambda_ * log_volume(E) * inverse; // 1 - C^-1 = 2 C^-1 E
}

Mat6 NeoHookean::tangent(const Mat3& E) const {
    constexpr std::array<std::array<int, 2>, 6> pairs{{{0, 0}, {1, 1}, {2, 2}, {0, 1}, {1, 2}, {2, 0}}};
    const Mat3 c = inverse_of_C(E);
    const Vec6 v = stress_vector(c);
    const double shear = mu_ - lambda_ * log_volume(E);
    Mat6 D;
    for (int r = 0; r < 6; ++r)
        for (int s = r; s < 6; ++s) {
            const auto [i, j] = pairs[static_cast<std::size_t>(r)];
            const auto [k, l] = pairs[static_cast<std::size_t>(s)];
            D(r, s) = D(s, r) = lambda_ * v[r] * v[s] + shear * (c(i, k) * c(j, l) + c(i, l) * c(j, k));
        }
    return D;
}

} // namespace osculate::material
