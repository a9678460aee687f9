#pragma once
/// Symmetric tensors as vectors in Voigt order xx yy zz xy yz zx.

#include "osculate/core/types.hpp"

namespace osculate::material {

/// The vector of a stress: its components unchanged.
[[nodiscard]] inline Vec6 stress_vector(const Mat3& S) {
    Vec6 v;
    v << S(0, 0), S(1, 1), S(2, 2), (S(0, 1) + S(1, 0)) / 2, (S(1, 2) + S(2, 1)) / 2, (S(2, 0) + S(0, 2)) / 2;
    return v;
}

/// The vector of a strain: shear components are doubled, so that the product of stress and strain vectors is the work.
[[nodiscard]] inline Vec6 strain_vector(const Mat3& E) {
    Vec6 v;
    v << E(0, 0), E(1, 1), E(2, 2), E(0, 1) + E(1, 0), E(1, 2) + E(2, 1), E(2, 0) + E(0, 2);
    return v;
}

/// The stress tensor of a vector.
[[nodiscard]] inline Mat3 stress_matrix(const Vec6& v) {
    Mat3 S;
    S << v(0), v(3), v(5), v(3), v(1), v(4), v(5), v(4), v(2);
    return S;
}

} // namespace osculate::material
