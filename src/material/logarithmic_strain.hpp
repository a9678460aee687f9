#pragma once
/// Logarithmic strain of a Green-Lagrange strain, with its derivatives.

#include "osculate/core/types.hpp"

namespace osculate::material {

/// e = ln(1 + 2 E) / 2 by eigenvalues, with first and second divided differences in place of quotients that lose digits where
/// eigenvalues are close.                                                                [Miehe, Lambrecht 2001; Carlson, Hoger 1986]
class LogarithmicStrain {
public:
    /// @pre 1 + 2 E is positive definite
    explicit LogarithmicStrain(const Mat3& E);

    [[nodiscard]] const Mat3& value() const { return value_; }
    /// T : de/dE, the stress that does the work of T.
    [[nodiscard]] Mat3 conjugate(const Mat3& T) const;
    /// de/dE : D : de/dE + T : d2e/dE2 in Voigt order with engineering shear strains; D and the result are symmetric.
    [[nodiscard]] Mat6 tangent(const Mat6& D, const Mat3& T) const;

private:
    [[nodiscard]] double first(int i, int j) const;
    [[nodiscard]] double second(int i, int j, int k) const;

    Vec3 x_;    ///< eigenvalues of E
    Mat3 axes_; ///< columns
    Mat3 value_;
    Mat3 slopes_; ///< first divided differences
};

} // namespace osculate::material
