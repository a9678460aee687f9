#pragma once
/// Isotropic linear elasticity at small strain.

#include "osculate/core/types.hpp"

namespace osculate::material {

/// Hooke's law. Strain and stress in Voigt order xx yy zz xy yz zx, with engineering shear strains (gamma = 2 eps).
/// @pre E > 0, -1 < nu < 1/2
struct LinearElastic {
    double E = 0;  ///< Young's modulus, Pa
    double nu = 0; ///< Poisson's ratio

    /// Lame's first constant, E nu / ((1 + nu) (1 - 2 nu)), Pa
    [[nodiscard]] double lambda() const { return E * nu / ((1 + nu) * (1 - 2 * nu)); }
    /// Shear modulus, E / (2 (1 + nu)), Pa
    [[nodiscard]] double mu() const { return E / (2 * (1 + nu)); }

    /// Tangent d stress / d strain, Pa, symmetric.
    [[nodiscard]] Mat6 stiffness() const;
    /// sigma = lambda tr(eps) 1 + 2 mu eps, Pa.
    [[nodiscard]] Vec6 stress(const Vec6& strain) const;
};

} // namespace osculate::material
