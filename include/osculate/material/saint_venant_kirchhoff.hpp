#pragma once
/// Hooke's law between Green-Lagrange strain and second Piola-Kirchhoff stress.

#include "osculate/material/linear_elastic.hpp"

namespace osculate::material {

/// psi = lambda/2 (tr E)^2 + mu E : E. For large rotations with small strains; it softens under strong compression, so
/// that elements collapse.
/// @pre as LinearElastic, with the same constants and the same small-strain response
class SaintVenantKirchhoff {
public:
    explicit SaintVenantKirchhoff(const LinearElastic& small_strain)
        : lambda_(small_strain.lambda()), mu_(small_strain.mu()), D_(small_strain.stiffness()) {}

    /// Energy per reference volume, J/m^3, at a Green-Lagrange strain E = (C - 1) / 2.
    [[nodiscard]] double energy(const Mat3& E) const;
    /// Second Piola-Kirchhoff stress S = lambda tr(E) 1 + 2 mu E, Pa.
    [[nodiscard]] Mat3 pk2(const Mat3& E) const;
    /// dS/dE, Pa, symmetric, in Voigt order with engineering shear strains.
    [[nodiscard]] Mat6 tangent(const Mat3& E) const;

private:
    double lambda_, mu_;
    Mat6 D_;
};

} // namespace osculate::material
