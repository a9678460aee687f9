#pragma once
/// Reference elements: shape functions, their gradients and a quadrature rule. Node order is VTK's.

#include "osculate/core/types.hpp"

#include <array>
#include <cmath>
#include <concepts>
#include <utility>

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

    static Positions node_positions() {
        Positions c;
        c.row(0) << -1, 1, 1, -1, -1, 1, 1, -1;
        c.row(1) << -1, -1, 1, 1, -1, -1, 1, 1;
        c.row(2) << -1, -1, -1, -1, 1, 1, 1, 1;
        return c;
    }

    static bool contains(const Vec3& xi, double tolerance) { return xi.cwiseAbs().maxCoeff() <= 1 + tolerance; }

    /// N_a = (1 + xi_a xi) (1 + eta_a eta) (1 + zeta_a zeta) / 8
    static Shape shape(const Vec3& xi) {
        const Positions c = node_positions();
        Shape N;
        for (int a = 0; a < nodes; ++a) N[a] = (Vec3::Ones() + c.col(a).cwiseProduct(xi)).prod() / 8;
        return N;
    }

    static Gradient gradient(const Vec3& xi) {
        const Positions c = node_positions();
        Gradient dN;
        for (int a = 0; a < nodes; ++a) {
            const Vec3 f = Vec3::Ones() + c.col(a).cwiseProduct(xi);
            dN.row(a) << c(0, a) * f[1] * f[2], f[0] * c(1, a) * f[2], f[0] * f[1] * c(2, a);
        }
        return dN / 8;
    }

    static std::array<QuadraturePoint, points> quadrature() {
        const Positions c = node_positions() / std::sqrt(3.0);
        std::array<QuadraturePoint, points> rule;
        for (int q = 0; q < points; ++q) rule[static_cast<std::size_t>(q)] = {c.col(q), 1.0};
        return rule;
    }

    static std::array<QuadraturePoint, mass_points> mass_quadrature() { return quadrature(); }
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

    static Positions node_positions() {
        Positions c = Positions::Zero();
        c.rightCols<3>().setIdentity();
        return c;
    }

    static bool contains(const Vec3& xi, double tolerance) {
        return xi.minCoeff() >= -tolerance && xi.sum() <= 1 + tolerance;
    }

    static Shape shape(const Vec3& xi) { return {1 - xi.sum(), xi[0], xi[1], xi[2]}; }

    static Gradient gradient(const Vec3&) {
        Gradient dN;
        dN.row(0).setConstant(-1);
        dN.bottomRows<3>().setIdentity();
        return dN;
    }

    static std::array<QuadraturePoint, points> quadrature() { return {{{Vec3::Constant(0.25), 1.0 / 6}}}; }

    static std::array<QuadraturePoint, mass_points> mass_quadrature() {
        const double a = (5 - std::sqrt(5.0)) / 20, b = (5 + 3 * std::sqrt(5.0)) / 20, w = 1.0 / 24;
        return {{{{a, a, a}, w}, {{b, a, a}, w}, {{a, b, a}, w}, {{a, a, b}, w}}};
    }
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

    static Positions node_positions() {
        Positions c;
        c.leftCols<4>() = Tet4::node_positions();
        for (int m = 0; m < 6; ++m) c.col(4 + m) = (c.col(edges[m][0]) + c.col(edges[m][1])) / 2;
        return c;
    }

    static bool contains(const Vec3& xi, double tolerance) { return Tet4::contains(xi, tolerance); }

    /// N_a = L_a (2 L_a - 1) at a corner, 4 L_a L_b midway between a and b
    static Shape shape(const Vec3& xi) {
        const Tet4::Shape L = Tet4::shape(xi);
        Shape N;
        for (int a = 0; a < 4; ++a) N[a] = L[a] * (2 * L[a] - 1);
        for (int m = 0; m < 6; ++m) N[4 + m] = 4 * L[edges[m][0]] * L[edges[m][1]];
        return N;
    }

    static Gradient gradient(const Vec3& xi) {
        const Tet4::Shape L = Tet4::shape(xi);
        const Tet4::Gradient dL = Tet4::gradient(xi);
        Gradient dN;
        for (int a = 0; a < 4; ++a) dN.row(a) = (4 * L[a] - 1) * dL.row(a);
        for (int m = 0; m < 6; ++m) {
            const int a = edges[m][0], b = edges[m][1];
            dN.row(4 + m) = 4 * (L[a] * dL.row(b) + L[b] * dL.row(a));
        }
        return dN;
    }

    static std::array<QuadraturePoint, points> quadrature() { return Tet4::mass_quadrature(); }

    static std::array<QuadraturePoint, mass_points> mass_quadrature() {
        std::array<QuadraturePoint, mass_points> rule;
        std::size_t q = 0;
        const auto vertex_orbit = [&](double a, double weight) {
            rule[q++] = {Vec3::Constant(a), weight};
            for (int i = 0; i < 3; ++i) rule[q++] = {Vec3::Constant(a) + (1 - 4 * a) * Vec3::Unit(i), weight};
        };
        vertex_orbit(0.31088591926330060980, 0.11268792571801585080 / 6);
        vertex_orbit(0.092735250310891226402, 0.073493043116361949544 / 6);
        const double a = 0.045503704125649649492, b = 0.5 - a, w = 0.042546020777081466438 / 6;
        for (int i = 0; i < 3; ++i) {
            rule[q++] = {Vec3::Constant(a) + (b - a) * Vec3::Unit(i), w};
            rule[q++] = {Vec3::Constant(b) + (a - b) * Vec3::Unit(i), w};
        }
        return rule;
    }
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

    static Positions node_positions() {
        Positions c;
        c.leftCols<8>() = Hex8::node_positions();
        for (int m = 0; m < 12; ++m) c.col(8 + m) = (c.col(edges[m][0]) + c.col(edges[m][1])) / 2;
        return c;
    }

    static bool contains(const Vec3& xi, double tolerance) { return Hex8::contains(xi, tolerance); }

    /// N_a = (1 + xi_a xi) (1 + eta_a eta) (1 + zeta_a zeta) (xi_a xi + eta_a eta + zeta_a zeta - 2) / 8 at a corner; midway
    /// along xi (1 - xi^2) (1 + eta_a eta) (1 + zeta_a zeta) / 4, the others likewise
    static Shape shape(const Vec3& xi) {
        const Positions c = node_positions();
        Shape N;
        for (int a = 0; a < nodes; ++a) {
            const Vec3 along = c.col(a).cwiseProduct(xi);
            if (a < 8)
                N[a] = (Vec3::Ones() + along).prod() * (along.sum() - 2) / 8;
            else {
                N[a] = 0.25;
                for (int k = 0; k < 3; ++k) N[a] *= c(k, a) == 0 ? 1 - xi[k] * xi[k] : 1 + along[k];
            }
        }
        return N;
    }

    static Gradient gradient(const Vec3& xi) {
        const Positions c = node_positions();
        Gradient dN;
        for (int a = 0; a < nodes; ++a) {
            const Vec3 along = c.col(a).cwiseProduct(xi);
            Vec3 f, df; // factors and their derivatives
            for (int k = 0; k < 3; ++k) {
                f[k] = c(k, a) == 0 ? 1 - xi[k] * xi[k] : 1 + along[k];
                df[k] = c(k, a) == 0 ? -2 * xi[k] : c(k, a);
            }
            const Vec3 others(f[1] * f[2], f[2] * f[0], f[0] * f[1]);
            if (a < 8)
                dN.row(a) = (df.cwiseProduct(others) * (along.sum() - 2) + f.prod() * c.col(a)).transpose() / 8;
            else
                dN.row(a) = df.cwiseProduct(others).transpose() / 4;
        }
        return dN;
    }

    static std::array<QuadraturePoint, points> quadrature() {
        const double g = std::sqrt(0.6);
        const std::array<double, 3> at{-g, 0, g}, weight{5.0 / 9, 8.0 / 9, 5.0 / 9};
        std::array<QuadraturePoint, points> rule;
        std::size_t q = 0;
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t j = 0; j < 3; ++j)
                for (std::size_t i = 0; i < 3; ++i)
                    rule[q++] = {{at[i], at[j], at[k]}, weight[i] * weight[j] * weight[k]};
        return rule;
    }

    static std::array<QuadraturePoint, mass_points> mass_quadrature() { return quadrature(); }
};

/// The same with the eight points of Hex8 for stiffness and stress: softer in bending and near incompressibility. They leave six
/// modes of an element without stiffness, which neighbours or supports may not hold. So the last fourteen points, exact to degree
/// five, have this share of the weights.    [Irons 1971, Quadrature rules for brick based finite elements]
struct Hex20Reduced : Hex20 {
    static constexpr double share = 1e-4;
    static constexpr int points = Hex8::points + 14;

    static std::array<QuadraturePoint, points> quadrature() {
        std::array<QuadraturePoint, points> rule;
        std::size_t q = 0;
        for (const QuadraturePoint& point : Hex8::quadrature()) rule[q++] = {point.xi, (1 - share) * point.weight};
        const double face = std::sqrt(19.0 / 30), corner = std::sqrt(19.0 / 33);
        for (int k = 0; k < 3; ++k)
            for (const double side : {-face, face}) rule[q++] = {side * Vec3::Unit(k), share * 320 / 361};
        for (int c = 0; c < Hex8::nodes; ++c) rule[q++] = {corner * Hex8::node_positions().col(c), share * 121 / 361};
        return rule;
    }
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

    static Positions node_positions() {
        Positions c;
        c.row(0) << 0, 0, 1, 0, 0, 1;
        c.row(1) << 0, 1, 0, 0, 1, 0;
        c.row(2) << -1, -1, -1, 1, 1, 1;
        return c;
    }

    static bool contains(const Vec3& xi, double tolerance) {
        return xi.head<2>().minCoeff() >= -tolerance && xi.head<2>().sum() <= 1 + tolerance &&
               std::abs(xi[2]) <= 1 + tolerance;
    }

    static Shape shape(const Vec3& xi) {
        const Vec3 L(1 - xi[0] - xi[1], xi[1], xi[0]);
        Shape N;
        N << L * (1 - xi[2]) / 2, L * (1 + xi[2]) / 2;
        return N;
    }

    static Gradient gradient(const Vec3& xi) {
        const Vec3 L(1 - xi[0] - xi[1], xi[1], xi[0]);
        Eigen::Matrix<double, 3, 2> dL;
        dL << -1, -1, 0, 1, 1, 0;
        Gradient dN;
        dN << dL * (1 - xi[2]) / 2, -L / 2, dL * (1 + xi[2]) / 2, L / 2;
        return dN;
    }

    static std::array<QuadraturePoint, points> quadrature() {
        const double g = 1 / std::sqrt(3.0);
        const double a = 1.0 / 6, b = 2.0 / 3, w = 1.0 / 6;
        return {{{{a, a, -g}, w}, {{a, b, -g}, w}, {{b, a, -g}, w}, {{a, a, g}, w}, {{a, b, g}, w}, {{b, a, g}, w}}};
    }

    static std::array<QuadraturePoint, mass_points> mass_quadrature() { return quadrature(); }
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

    static Positions node_positions() {
        Positions c;
        c.leftCols<6>() = Wedge6::node_positions();
        for (int m = 0; m < 9; ++m) c.col(6 + m) = (c.col(edges[m][0]) + c.col(edges[m][1])) / 2;
        return c;
    }

    static bool contains(const Vec3& xi, double tolerance) { return Wedge6::contains(xi, tolerance); }

    /// With t_a = -1 or 1: N_a = L_a (2 L_a - 1) (1 + t_a t)/2 - L_a (1 - t^2)/2 at a corner, 2 L_a L_b (1 + t_a t) midway between
    /// a and b of a triangle, L_a (1 - t^2) midway along t.
    static Shape shape(const Vec3& xi) {
        const Vec3 L = areas(xi);
        const double t = xi[2], hump = 1 - t * t;
        Shape N;
        for (int a = 0; a < 6; ++a) {
            const double l = L[a % 3], side = 1 + (a < 3 ? -t : t);
            N[a] = l * (2 * l - 1) * side / 2 - l * hump / 2;
            N[6 + a] = 2 * l * L[(a + 1) % 3] * side;
        }
        N.tail<3>() = L * hump;
        return N;
    }

    static Gradient gradient(const Vec3& xi) {
        const Vec3 L = areas(xi);
        Eigen::Matrix<double, 3, 2> dL;
        dL << -1, -1, 0, 1, 1, 0;
        const double t = xi[2], hump = 1 - t * t;
        Gradient dN;
        for (int a = 0; a < 6; ++a) {
            const int i = a % 3, j = (a + 1) % 3;
            const double sign = a < 3 ? -1 : 1, side = 1 + sign * t;
            dN.row(a) << dL.row(i) * ((4 * L[i] - 1) * side - hump) / 2, sign * L[i] * (2 * L[i] - 1) / 2 + L[i] * t;
            dN.row(6 + a) << 2 * side * (L[i] * dL.row(j) + L[j] * dL.row(i)), 2 * sign * L[i] * L[j];
        }
        for (int i = 0; i < 3; ++i) dN.row(12 + i) << dL.row(i) * hump, -2 * t * L[i];
        return dN;
    }

    static std::array<QuadraturePoint, points> quadrature() {
        constexpr double a = 1.0 / 6, b = 2.0 / 3;
        return along_line<points>({{{a, a, a}, {a, b, a}, {b, a, a}}});
    }

    /// [Strang and Fix 1973; Dunavant 1985]
    static std::array<QuadraturePoint, mass_points> mass_quadrature() {
        const double root = std::sqrt(38 - 44 * std::sqrt(0.4)), ten = std::sqrt(10.0);
        const double a = (8 - ten + root) / 18, b = (8 - ten - root) / 18;
        const double uneven = std::sqrt(213125 - 53320 * ten) / 7440, w = 620.0 / 7440;
        return along_line<mass_points>({{{a, a, w + uneven},
                                         {1 - 2 * a, a, w + uneven},
                                         {a, 1 - 2 * a, w + uneven},
                                         {b, b, w - uneven},
                                         {1 - 2 * b, b, w - uneven},
                                         {b, 1 - 2 * b, w - uneven}}});
    }

private:
    static Vec3 areas(const Vec3& xi) { return {1 - xi[0] - xi[1], xi[1], xi[0]}; }

    /// A rule of the triangle, (r, s, weight), times three Gauss points.
    template <std::size_t n> static std::array<QuadraturePoint, n> along_line(const std::array<Vec3, n / 3>& triangle) {
        const double g = std::sqrt(0.6);
        std::array<QuadraturePoint, n> rule;
        std::size_t q = 0;
        for (const auto& [t, weight] : {std::pair{-g, 5.0 / 9}, std::pair{0.0, 8.0 / 9}, std::pair{g, 5.0 / 9}})
            for (const Vec3& p : triangle) rule[q++] = {{p[0], p[1], t}, p[2] * weight};
        return rule;
    }
};

static_assert(ReferenceElement<Hex8> && ReferenceElement<Tet4> && ReferenceElement<Wedge6> && ReferenceElement<Tet10> &&
              ReferenceElement<Hex20> && ReferenceElement<Hex20Reduced> && ReferenceElement<Wedge15>);

} // namespace osculate::fe
