#pragma once
/// Compressible neo-Hookean elasticity.

#include "osculate/material/linear_elastic.hpp"

namespace osculate::material {

/// psi = mu/2 (I1 - 3) - mu ln J + lambda/2 (ln J)^2, infinite at zero volume.
/// [Bonet, Wood 2008, Nonlinear Continuum Mechanics for Finite Element Analysis, eq (6.27)]
/// @pre as LinearElastic, with the same constants and the same small-strain response
class NeoHookean {
public:
    explicit NeoHookean(const LinearElastic& small_strain) : lambda_(small_strain.lambda()), mu_(small_strain.mu()) {}

    /// Energy per reference volume, J/m^3, at a Green-Lagrange strain E = (C - 1) / 2.
    /// @pre C is positive definite
    [[nodiscard]] double energy(const Mat3& E) const;
    /// Second Piola-Kirchhoff stress S = mu (1 - C^-1) + lambda ln J C^-1, Pa.
    [[nodiscard]] Mat3 pk2(const Mat3& E) const;
    /// dS/dE = lambda C^-1 x C^-1 + 2 (mu - lambda ln J) I_C^-1, Pa, symmetric, in Voigt order with engineering shear
    /// strains; I_C^-1 maps a symmetric A to C^-1 A C^-1.
    [[nodiscard]] Mat6 tangent(const Mat3& E) const;

private:
    double lambda_, mu_;
};

} // namespace osculate::material
