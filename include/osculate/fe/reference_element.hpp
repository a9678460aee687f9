#pragma once
/// Reference elements: shape functions, their gradients and a quadrature rule. Node order is VTK's.

#include "osculate/core/types.hpp"

#include <array>
#include <concepts>

namespace osculate::fe {

struct QuadraturePoint {
    Vec3 xi;       ///< natural coordinates
    double weight; ///< the weights of a rule sum to the volume of the reference element
};

/// What a volume element must provide: its degree, counts, natural coordinates of its nodes, whether it contains xi
/// (give or take a tolerance in natural coordinates), N(xi), dN/dxi and two quadrature rules: one for stiffness and
/// stress, and one for mass, body forces and volume, exact for N_a N_b on an affine element.
template <class E>
concept ReferenceElement = requires(const Vec3& xi, double tolerance) {
    requires E::nodes >
    0 && E::degree > 0 && E::points > 0 && E::mass_points > 0;
    { E::node_positions() } -> std::same_as<Eigen::Matrix<double, 3, E::nodes>>;
    { E::contains(xi, tolerance) } -> std::same_as<bool>;
    { E::shape(xi) } -> std::same_as<Eigen::Matrix<double, E::nodes, 1>>;
    { E::gradient(xi) } -> std::same_as<Eigen::Matrix<double, E::nodes, 3>>;
    { E::quadrature() } -> std::same_as<std::array<QuadraturePoint, E::points>>;
    { E::mass_quadrature() } -> std::same_as<std::array<QuadraturePoint, E::mass_points>>;
};

/// Trilinear hexahedron on [-1, 1]^3, 2 x 2 x 2 Gauss points in the order of the nodes.
struct Hex8 {
    static constexpr int nodes = 8;
    static constexpr int degree = 1;
    static constexpr int points = 8;
    static constexpr int mass_points = 8;
    using Shape = Eigen::Matrix<double, nodes, 1>;
    using Gradient = Eigen::Matrix<double, nodes, 3>;
    using Positions = Eigen::Matrix<double, 3, nodes>;

    static Positions node_positions();
    static bool contains(const Vec3& xi, double tolerance);
    /// N_a = (1 + xi_a xi) (1 + eta_a eta) (1 + zeta_a zeta) / 8
    static Shape shape(const Vec3& xi);
    static Gradient gradient(const Vec3& xi);
    static std::array<QuadraturePoint, points> quadrature();
    static std::array<QuadraturePoint, mass_points> mass_quadrature();
};

/// Linear tetrahedron on 0 <= r, s, t, r + s + t <= 1; one point, exact for its constant strain, and four points of
/// degree two for its mass.
struct Tet4 {
    static constexpr int nodes = 4;
    static constexpr int degree = 1;
    static constexpr int points = 1;
    static constexpr int mass_points = 4;
    using Shape = Eigen::Matrix<double, nodes, 1>;
    using Gradient = Eigen::Matrix<double, nodes, 3>;
    using Positions = Eigen::Matrix<double, 3, nodes>;

    static Positions node_positions();
    static bool contains(const Vec3& xi, double tolerance);
    static Shape shape(const Vec3& xi);
    static Gradient gradient(const Vec3&);
    static std::array<QuadraturePoint, points> quadrature();
    static std::array<QuadraturePoint, mass_points> mass_quadrature();
};

/// Quadratic tetrahedron on the same reference tetrahedron, midside nodes on the edges 01, 12, 20, 03, 13, 23. Four
/// points of degree two for its stiffness, exact for straight edges; fourteen of degree five, all weights positive, for
/// its mass.                                          [Walkington 2000, Quadrature on simplices of arbitrary dimension]
struct Tet10 {
    static constexpr int nodes = 10;
    static constexpr int degree = 2;
    static constexpr int points = 4;
    static constexpr int mass_points = 14;
    using Shape = Eigen::Matrix<double, nodes, 1>;
    using Gradient = Eigen::Matrix<double, nodes, 3>;
    using Positions = Eigen::Matrix<double, 3, nodes>;
    static constexpr int edges[6][2] = {{0, 1}, {1, 2}, {2, 0}, {0, 3}, {1, 3}, {2, 3}};

    static Positions node_positions();
    static bool contains(const Vec3& xi, double tolerance);
    /// N_a = L_a (2 L_a - 1) at a corner, 4 L_a L_b midway between a and b
    static Shape shape(const Vec3& xi);
    static Gradient gradient(const Vec3& xi);
    static std::array<QuadraturePoint, points> quadrature();
    static std::array<QuadraturePoint, mass_points> mass_quadrature();
};

/// Quadratic serendipity hexahedron on the same cube as Hex8, midside nodes on the edges 01, 12, 23, 30, 45, 56, 67, 74, 04,
/// 15, 26, 37; 3 x 3 x 3 Gauss points.
struct Hex20 {
    static constexpr int nodes = 20;
    static constexpr int degree = 2;
    static constexpr int points = 27;
    static constexpr int mass_points = 27;
    using Shape = Eigen::Matrix<double, nodes, 1>;
    using Gradient = Eigen::Matrix<double, nodes, 3>;
    using Positions = Eigen::Matrix<double, 3, nodes>;
    static constexpr int edges[12][2] = {{0, 1}, {1, 2}, {2, 3}, {3, 0}, {4, 5}, {5, 6},
                                         {6, 7}, {7, 4}, {0, 4}, {1, 5}, {2, 6}, {3, 7}};

    static Positions node_positions();
    static bool contains(const Vec3& xi, double tolerance);
    /// N_a = (1 + xi_a xi) (1 + eta_a eta) (1 + zeta_a zeta) (xi_a xi + eta_a eta + zeta_a zeta - 2) / 8 at a corner; midway
    /// along xi (1 - xi^2) (1 + eta_a eta) (1 + zeta_a zeta) / 4, the others likewise
    static Shape shape(const Vec3& xi);
    static Gradient gradient(const Vec3& xi);
    static std::array<QuadraturePoint, points> quadrature();
    static std::array<QuadraturePoint, mass_points> mass_quadrature();
};

/// The same with the eight points of Hex8 for stiffness and stress: softer in bending and near incompressibility. They leave six
/// modes of an element without stiffness, which neighbours or supports may not hold. So the last fourteen points, exact to degree
/// five, have this share of the weights.    [Irons 1971, Quadrature rules for brick based finite elements]
struct Hex20Reduced : Hex20 {
    static constexpr double share = 1e-4;
    static constexpr int points = Hex8::points + 14;

    static std::array<QuadraturePoint, points> quadrature();
};

/// Linear wedge: triangle (r, s) times line t in [-1, 1]; 3 x 2 points, exact for its volume and its body forces. In
/// VTK's order the normal of the triangle (0, 1, 2) points out of the element, so node 1 is on the s axis and node 2 on
/// r.
struct Wedge6 {
    static constexpr int nodes = 6;
    static constexpr int degree = 1;
    static constexpr int points = 6;
    static constexpr int mass_points = 6;
    using Shape = Eigen::Matrix<double, nodes, 1>;
    using Gradient = Eigen::Matrix<double, nodes, 3>;
    using Positions = Eigen::Matrix<double, 3, nodes>;

    static Positions node_positions();
    static bool contains(const Vec3& xi, double tolerance);
    static Shape shape(const Vec3& xi);
    static Gradient gradient(const Vec3& xi);
    static std::array<QuadraturePoint, points> quadrature();
    static std::array<QuadraturePoint, mass_points> mass_quadrature();
};

/// Quadratic serendipity wedge on the same prism as Wedge6, midside nodes on the edges 01, 12, 20, 34, 45, 53, 03, 14, 25. 3 x 3
/// points for its stiffness, of degree two in the triangle, and 6 x 3 of degree four for its mass.
struct Wedge15 {
    static constexpr int nodes = 15;
    static constexpr int degree = 2;
    static constexpr int points = 9;
    static constexpr int mass_points = 18;
    using Shape = Eigen::Matrix<double, nodes, 1>;
    using Gradient = Eigen::Matrix<double, nodes, 3>;
    using Positions = Eigen::Matrix<double, 3, nodes>;
    static constexpr int edges[9][2] = {{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}};

    static Positions node_positions();
    static bool contains(const Vec3& xi, double tolerance);
    /// With t_a = -1 or 1: N_a = L_a (2 L_a - 1) (1 + t_a t)/2 - L_a (1 - t^2)/2 at a corner, 2 L_a L_b (1 + t_a t) midway between
    /// a and b of a triangle, L_a (1 - t^2) midway along t.
    static Shape shape(const Vec3& xi);
    static Gradient gradient(const Vec3& xi);
    static std::array<QuadraturePoint, points> quadrature();
    /// [Strang and Fix 1973; Dunavant 1985]
    static std::array<QuadraturePoint, mass_points> mass_quadrature();
};

static_assert(ReferenceElement<Hex8> && ReferenceElement<Tet4> && ReferenceElement<Wedge6> && ReferenceElement<Tet10> &&
              ReferenceElement<Hex20> && ReferenceElement<Hex20Reduced> && ReferenceElement<Wedge15>);

} // namespace osculate::fe
