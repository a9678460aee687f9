#include "osculate/fe/reference_element.hpp"

#include <cmath>
#include <utility>

namespace osculate::fe {

auto Hex8::node_positions() -> Positions {
    Positions c;
    c.row(0) << -1, 1, 1, -1, -1, 1, 1, -1;
    c.row(1) << -1, -1, 1, 1, -1, -1, 1, 1;
    c.row(2) << -1, -1, -1, -1, 1, 1, 1, 1;
    return c;
}

bool Hex8::contains(const Vec3& xi, double tolerance) {
    return xi.cwiseAbs().maxCoeff() <= 1 + tolerance;
}

auto Hex8::shape(const Vec3& xi) -> Shape {
    const Positions c = node_positions();
    Shape N;
    for (int a = 0; a < nodes; ++a) N[a] = (Vec3::Ones() + c.col(a).cwiseProduct(xi)).prod() / 8;
    return N;
}

auto Hex8::gradient(const Vec3& xi) -> Gradient {
    const Positions c = node_positions();
    Gradient dN;
    for (int a = 0; a < nodes; ++a) {
        const Vec3 f = Vec3::Ones() + c.col(a).cwiseProduct(xi);
        dN.row(a) << c(0, a) * f[1] * f[2], f[0] * c(1, a) * f[2], f[0] * f[1] * c(2, a);
    }
    return dN / 8;
}

auto Hex8::quadrature() -> std::array<QuadraturePoint, points> {
    const Positions c = node_positions() / std::sqrt(3.0);
    std::array<QuadraturePoint, points> rule;
    for (int q = 0; q < points; ++q) rule[static_cast<std::size_t>(q)] = {c.col(q), 1.0};
    return rule;
}

auto Hex8::mass_quadrature() -> std::array<QuadraturePoint, mass_points> {
    return quadrature();
}

auto Tet4::node_positions() -> Positions {
    Positions c = Positions::Zero();
    c.rightCols<3>().setIdentity();
    return c;
}

bool Tet4::contains(const Vec3& xi, double tolerance) {
    return xi.minCoeff() >= -tolerance && xi.sum() <= 1 + tolerance;
}

auto Tet4::shape(const Vec3& xi) -> Shape {
    return {1 - xi.sum(), xi[0], xi[1], xi[2]};
}

auto Tet4::gradient(const Vec3&) -> Gradient {
    Gradient dN;
    dN.row(0).setConstant(-1);
    dN.bottomRows<3>().setIdentity();
    return dN;
}

auto Tet4::quadrature() -> std::array<QuadraturePoint, points> {
    return {{{Vec3::Constant(0.25), 1.0 / 6}}};
}

auto Tet4::mass_quadrature() -> std::array<QuadraturePoint, mass_points> {
    const double a = (5 - std::sqrt(5.0)) / 20, b = (5 + 3 * std::sqrt(5.0)) / 20, w = 1.0 / 24;
    return {{{{a, a, a}, w}, {{b, a, a}, w}, {{a, b, a}, w}, {{a, a, b}, w}}};
}

auto Tet10::node_positions() -> Positions {
    Positions c;
    c.leftCols<4>() = Tet4::node_positions();
    for (int m = 0; m < 6; ++m) c.col(4 + m) = (c.col(edges[m][0]) + c.col(edges[m][1])) / 2;
    return c;
}

bool Tet10::contains(const Vec3& xi, double tolerance) {
    return Tet4::contains(xi, tolerance);
}

auto Tet10::shape(const Vec3& xi) -> Shape {
    const Tet4::Shape L = Tet4::shape(xi);
    Shape N;
    for (int a = 0; a < 4; ++a) N[a] = L[a] * (2 * L[a] - 1);
    for (int m = 0; m < 6; ++m) N[4 + m] = 4 * L[edges[m][0]] * L[edges[m][1]];
    return N;
}

auto Tet10::gradient(const Vec3& xi) -> Gradient {
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

auto Tet10::quadrature() -> std::array<QuadraturePoint, points> {
    return Tet4::mass_quadrature();
}

auto Tet10::mass_quadrature() -> std::array<QuadraturePoint, mass_points> {
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

auto Hex20::node_positions() -> Positions {
    Positions c;
    c.leftCols<8>() = Hex8::node_positions();
    for (int m = 0; m < 12; ++m) c.col(8 + m) = (c.col(edges[m][0]) + c.col(edges[m][1])) / 2;
    return c;
}

bool Hex20::contains(const Vec3& xi, double tolerance) {
    return Hex8::contains(xi, tolerance);
}

auto Hex20::shape(const Vec3& xi) -> Shape {
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

auto Hex20::gradient(const Vec3& xi) -> Gradient {
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

auto Hex20::quadrature() -> std::array<QuadraturePoint, points> {
    const double g = std::sqrt(0.6);
    const std::array<double, 3> at{-g, 0, g}, weight{5.0 / 9, 8.0 / 9, 5.0 / 9};
    std::array<QuadraturePoint, points> rule;
    std::size_t q = 0;
    for (std::size_t k = 0; k < 3; ++k)
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t i = 0; i < 3; ++i) rule[q++] = {{at[i], at[j], at[k]}, weight[i] * weight[j] * weight[k]};
    return rule;
}

auto Hex20::mass_quadrature() -> std::array<QuadraturePoint, mass_points> {
    return quadrature();
}

auto Hex20Reduced::quadrature() -> std::array<QuadraturePoint, points> {
    std::array<QuadraturePoint, points> rule;
    std::size_t q = 0;
    for (const QuadraturePoint& point : Hex8::quadrature()) rule[q++] = {point.xi, (1 - share) * point.weight};
    const double face = std::sqrt(19.0 / 30), corner = std::sqrt(19.0 / 33);
    for (int k = 0; k < 3; ++k)
        for (const double side : {-face, face}) rule[q++] = {side * Vec3::Unit(k), share * 320 / 361};
    for (int c = 0; c < Hex8::nodes; ++c) rule[q++] = {corner * Hex8::node_positions().col(c), share * 121 / 361};
    return rule;
}

auto Wedge6::node_positions() -> Positions {
    Positions c;
    c.row(0) << 0, 0, 1, 0, 0, 1;
    c.row(1) << 0, 1, 0, 0, 1, 0;
    c.row(2) << -1, -1, -1, 1, 1, 1;
    return c;
}

bool Wedge6::contains(const Vec3& xi, double tolerance) {
    return xi.head<2>().minCoeff() >= -tolerance && xi.head<2>().sum() <= 1 + tolerance &&
           std::abs(xi[2]) <= 1 + tolerance;
}

auto Wedge6::shape(const Vec3& xi) -> Shape {
    const Vec3 L(1 - xi[0] - xi[1], xi[1], xi[0]);
    Shape N;
    N << L * (1 - xi[2]) / 2, L * (1 + xi[2]) / 2;
    return N;
}

auto Wedge6::gradient(const Vec3& xi) -> Gradient {
    const Vec3 L(1 - xi[0] - xi[1], xi[1], xi[0]);
    Eigen::Matrix<double, 3, 2> dL;
    dL << -1, -1, 0, 1, 1, 0;
    Gradient dN;
    dN << dL * (1 - xi[2]) / 2, -L / 2, dL * (1 + xi[2]) / 2, L / 2;
    return dN;
}

auto Wedge6::quadrature() -> std::array<QuadraturePoint, points> {
    const double g = 1 / std::sqrt(3.0);
    const double a = 1.0 / 6, b = 2.0 / 3, w = 1.0 / 6;
    return {{{{a, a, -g}, w}, {{a, b, -g}, w}, {{b, a, -g}, w}, {{a, a, g}, w}, {{a, b, g}, w}, {{b, a, g}, w}}};
}

auto Wedge6::mass_quadrature() -> std::array<QuadraturePoint, mass_points> {
    return quadrature();
}

namespace {

Vec3 areas(const Vec3& xi) {
    return {1 - xi[0] - xi[1], xi[1], xi[0]};
}

/// A rule of the triangle, (r, s, weight), times three Gauss points.
template <std::size_t n> std::array<QuadraturePoint, n> along_line(const std::array<Vec3, n / 3>& triangle) {
    const double g = std::sqrt(0.6);
    std::array<QuadraturePoint, n> rule;
    std::size_t q = 0;
    for (const auto& [t, weight] : {std::pair{-g, 5.0 / 9}, std::pair{0.0, 8.0 / 9}, std::pair{g, 5.0 / 9}})
        for (const Vec3& p : triangle) rule[q++] = {{p[0], p[1], t}, p[2] * weight};
    return rule;
}

} // namespace

auto Wedge15::node_positions() -> Positions {
    Positions c;
    c.leftCols<6>() = Wedge6::node_positions();
    for (int m = 0; m < 9; ++m) c.col(6 + m) = (c.col(edges[m][0]) + c.col(edges[m][1])) / 2;
    return c;
}

bool Wedge15::contains(const Vec3& xi, double tolerance) {
    return Wedge6::contains(xi, tolerance);
}

auto Wedge15::shape(const Vec3& xi) -> Shape {
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

auto Wedge15::gradient(const Vec3& xi) -> Gradient {
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

auto Wedge15::quadrature() -> std::array<QuadraturePoint, points> {
    constexpr double a = 1.0 / 6, b = 2.0 / 3;
    return along_line<points>({{{a, a, a}, {a, b, a}, {b, a, a}}});
}

auto Wedge15::mass_quadrature() -> std::array<QuadraturePoint, mass_points> {
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

} // namespace osculate::fe
