#pragma once
/// A sum and its rounding error.

#include "osculate/core/types.hpp"

namespace osculate {

/// Returns the rounding error of the sum: a + b = sum + result, exactly (Knuth). The compiler must not contract or
/// reassociate, see cmake/Options.cmake.
inline double rounded_off(double a, double b, double& sum) {
    sum = a + b;
    const double of_b = sum - a, of_a = sum - of_b;
    return (a - of_a) + (b - of_b);
}

/// The same for each component.
inline Vec3 rounded_off(const Vec3& a, const Vec3& b, Vec3& sum) {
    Vec3 tail;
    for (int k = 0; k < 3; ++k) tail(k) = rounded_off(a(k), b(k), sum(k));
    return tail;
}

} // namespace osculate
