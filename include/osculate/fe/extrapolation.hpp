#pragma once
/// Extrapolation of stresses and strains from the quadrature points to the nodes of an element.

#include "osculate/core/dense_algebra.hpp"
#include "osculate/fe/reference_element.hpp"

namespace osculate::fe {

/// The element whose shape functions fit the quadrature points of a stress field: one function per point, where
/// possible.
template <ReferenceElement E> struct StressField { using Element = E; };
template <> struct StressField<Tet10> { using Element = Tet4; };
template <> struct StressField<Hex20Reduced> { using Element = Hex8; };

/// Matrix (nodes x points) from point values to nodal values. Exact for a field in the span of the stress field's shape
/// functions if there are as many points as functions; the mean if there is one point.
template <ReferenceElement E> Eigen::Matrix<double, E::nodes, E::points> extrapolation() {
    using Field = typename StressField<E>::Element;
    const auto rule = E::quadrature();
    Matrix at_points(E::points, Field::nodes);
    for (int q = 0; q < E::points; ++q) {
        at_points.row(q) = Field::shape(rule[static_cast<std::size_t>(q)].xi).transpose();
    }
    Matrix at_nodes(E::nodes, Field::nodes);
    for (int a = 0; a < E::nodes; ++a) at_nodes.row(a) = Field::shape(E::node_positions().col(a)).transpose();
    return at_nodes * pseudo_inverse(at_points);
}

} // namespace osculate::fe
