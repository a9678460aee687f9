#pragma once
/// Small-strain formulations; those of hexahedra alone are in small_strain_hex.hpp. Each turns one element into strain operators B_q with strain = B_q u at point q, so that
/// stiffness sum_q B_q^T D B_q dV_q and stress D B_q u read the same for all of them.

#include "osculate/fe/isoparametric_map.hpp"

namespace osculate::fe {

/// Strain operators and volumes of the quadrature points of one element.
template <ReferenceElement E> struct StrainPoints {
    using Operator = Eigen::Matrix<double, 6, 3 * E::nodes>;
    std::array<Operator, E::points> B;
    std::array<double, E::points> volumes;
};

/// The strain of the displacement field, nothing else.
template <ReferenceElement E> struct DisplacementStrain {
    static constexpr int nodes = E::nodes;
    using Element = E;

    explicit DisplacementStrain(const Mat6&) {}

    void operator()(const ShapeTable<E>& table, const Eigen::Matrix<double, 3, nodes>& X, StrainPoints<E>& out) const {
        const ElementPoints<E> points(table, X);
        out.volumes = points.volumes;
        for (std::size_t q = 0; q < out.B.size(); ++q) out.B[q] = strain_operator<nodes>(points.gradients[q]);
    }
};

} // namespace osculate::fe
