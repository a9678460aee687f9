#pragma once
/// Extrapolation of stresses and strains from the quadrature points to the nodes of an element.

#include "osculate/core/dense_algebra.hpp"
#include "osculate/fe/reference_element.hpp"

namespace osculate::fe {

/// The element whose shape functions fit the quadrature points of a stress field: one function per point, where
/// possible; and how many points, the first ones, tell the field.
template <ReferenceElement E> struct StressField {
    using Element = E;
    static constexpr int points = E::points;
};
template <> struct StressField<Tet10> {
    using Element = Tet4;
    static constexpr int points = Tet10::points;
};
template <> struct StressField<Wedge15> {
    using Element = Wedge6;
    static constexpr int points = Wedge15::points;
};
template <> struct StressField<Hex20Reduced> {
    using Element = Hex8;
    static constexpr int points = Hex8::points;
};

/// Matrix (nodes x points) from point values to nodal values. Exact for a field in the span of the stress field's shape
/// functions if there are as many points as functions; the mean if there is one point.
template <ReferenceElement E> Eigen::Matrix<double, E::nodes, E::points> extrapolation() {
    using Field = typename StressField<E>::Element;
    const auto rule = E::quadrature();
    constexpr int points = StressField<E>::points;
    Matrix at_points(points, Field::nodes);
    for (int q = 0; q < points; ++q) {
        at_points.row(q) = Field::shape(rule[static_cast<std::size_t>(q)].xi).transpose();
    }
    Matrix at_nodes(E::nodes, Field::nodes);
    for (int a = 0; a < E::nodes; ++a) at_nodes.row(a) = Field::shape(E::node_positions().col(a)).transpose();
    Eigen::Matrix<double, E::nodes, E::points> result = Eigen::Matrix<double, E::nodes, E::points>::Zero();
    result.template leftCols<points>() = at_nodes * pseudo_inverse(at_points);
    return result;
}

} // namespace osculate::fe
