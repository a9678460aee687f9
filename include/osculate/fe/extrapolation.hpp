#pragma once
/// The way that stresses and strains take from the quadrature points to the nodes of an element.

#include "osculate/core/dense_algebra.hpp"
#include "osculate/fe/reference_element.hpp"

namespace osculate::fe {

/// The element whose shape functions fit the points of a stress field: as many as there are points, where possible.
template <ReferenceElement E> struct StressField { using Element = E; };
template <> struct StressField<Tet10> { using Element = Tet4; };

/// Nodes x points: carries point values to the nodes, exact for a field in the span of the stress field's shape functions
/// where there are as many points as those, the mean where there is one point.
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
