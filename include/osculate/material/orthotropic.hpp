#pragma once
/// Linear elasticity with three planes of symmetry, at small strain.

#include "osculate/core/types.hpp"

namespace osculate::material {

/// Hooke's law between the axes of a material: strain_11 = s_11/E_1 - nu_12 s_11... so that nu_ij is the contraction along j
/// under tension along i, nu_ij/E_i = nu_ji/E_j; gamma_ij = s_ij/G_ij.
struct Orthotropic {
    Vec3 E = Vec3::Zero();        ///< Young's moduli along the axes, Pa
    Vec3 nu = Vec3::Zero();       ///< nu_12, nu_13, nu_23
    Vec3 G = Vec3::Zero();        ///< shear moduli G_12, G_13, G_23, Pa
    Mat3 axes = Mat3::Identity(); ///< columns, orthonormal

    /// d stress / d strain in global components, Pa, Voigt order xx yy zz xy yz zx with engineering shear strains, symmetric.
    [[nodiscard]] Mat6 stiffness() const;
    /// Whether every strain stores energy.
    [[nodiscard]] bool stable() const;
};

} // namespace osculate::material
