#pragma once
/// The map from a reference element to an element in space, at its quadrature points.

#include "osculate/fe/reference_element.hpp"

#include <Eigen/LU>
#include <stdexcept>

namespace osculate::fe {

/// Gradients dN/dX (n x 3, 1/m) of n functions at one point.
template <int n> using Gradients = Eigen::Matrix<double, n, 3>;

/// Shape functions and natural gradients of E at every point of a quadrature rule; built once per kernel.
template <ReferenceElement E, std::size_t points = std::size_t{E::points}> struct ShapeTable {
    std::array<typename E::Shape, points> N;
    std::array<typename E::Gradient, points> dN;
    std::array<QuadraturePoint, points> rule;

    explicit ShapeTable(const std::array<QuadraturePoint, points>& quadrature) : rule(quadrature) {
        for (std::size_t q = 0; q < rule.size(); ++q) {
            N[q] = E::shape(rule[q].xi);
            dN[q] = E::gradient(rule[q].xi);
        }
    }
};

/// Jacobian J = dX/dxi of the map and its determinant.
struct Jacobian {
    Mat3 J;
    double det;
};

/// J_ij = sum_a X_ia dN_a/dxi_j
/// @throws std::runtime_error unless det J > 0
template <int n> Jacobian jacobian(const Eigen::Matrix<double, 3, n>& X, const Gradients<n>& dN) {
    Jacobian map;
    map.J.noalias() = X * dN;
    map.det = map.J.determinant();
    if (!(map.det > 0)) throw std::runtime_error("element with a non-positive Jacobian");
    return map;
}

/// Spatial gradients and volume at every quadrature point of one element.
template <ReferenceElement E> struct ElementPoints {
    std::array<Gradients<E::nodes>, E::points> gradients; ///< dN/dX = dN/dxi J^-1
    std::array<double, E::points> volumes;                ///< w det J, m^3

    ElementPoints(const ShapeTable<E>& table, const Eigen::Matrix<double, 3, E::nodes>& X) {
        for (std::size_t q = 0; q < volumes.size(); ++q) {
            const Jacobian map = jacobian<E::nodes>(X, table.dN[q]);
            gradients[q].noalias() = table.dN[q] * map.J.inverse();
            volumes[q] = table.rule[q].weight * map.det;
        }
    }
};

/// Small-strain operator B (6 x 3n) of n functions: strain = B u, Voigt xx yy zz xy yz zx, engineering shear strains.
template <int n> Eigen::Matrix<double, 6, 3 * n> strain_operator(const Gradients<n>& g) {
    Eigen::Matrix<double, 6, 3 * n> B;
    for (int a = 0; a < n; ++a) {
        const double x = g(a, 0), y = g(a, 1), z = g(a, 2);
        B.template middleCols<3>(3 * a) << x, 0, 0, //
            0, y, 0,                                //
            0, 0, z,                                //
            y, x, 0,                                //
            0, z, y,                                //
            z, 0, x;
    }
    return B;
}

} // namespace osculate::fe
