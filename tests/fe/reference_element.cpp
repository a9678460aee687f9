#include "osculate/fe/reference_element.hpp"

#include <gtest/gtest.h>

namespace osculate::fe {
namespace {

constexpr double round_off = 1e-14;   // polynomials of degree three at most, arguments of order one
constexpr double difference = 1e-9;   // central differences of step 1e-5: error about step^2 times a third derivative
const Vec3 inside(0.21, 0.34, -0.17); // a point without symmetry, inside every reference element but the tetrahedron

template <class E> class ReferenceElementTest : public ::testing::Test {};

template <class E> struct Facts;
template <> struct Facts<Hex8> { static constexpr double volume = 8; };
template <> struct Facts<Tet4> { static constexpr double volume = 1.0 / 6; };
template <> struct Facts<Wedge6> { static constexpr double volume = 1; };
template <> struct Facts<Tet10> { static constexpr double volume = 1.0 / 6; };

using Elements = ::testing::Types<Hex8, Tet4, Wedge6, Tet10>;
TYPED_TEST_SUITE(ReferenceElementTest, Elements);

TYPED_TEST(ReferenceElementTest, ShapeFunctionsAreOneAtTheirNodeAndZeroAtTheOthers) {
    const auto positions = TypeParam::node_positions();
    for (int b = 0; b < TypeParam::nodes; ++b) {
        const auto expected = TypeParam::Shape::Unit(b);
        EXPECT_LT((TypeParam::shape(positions.col(b)) - expected).norm(), round_off) << "node " << b;
    }
}

TYPED_TEST(ReferenceElementTest, ShapeFunctionsReproduceOneAndTheCoordinates) {
    const auto N = TypeParam::shape(inside);
    EXPECT_NEAR(N.sum(), 1, round_off);
    EXPECT_LT((TypeParam::node_positions() * N - inside).norm(), round_off);
}

TYPED_TEST(ReferenceElementTest, GradientIsTheDerivativeOfTheShapeFunctions) {
    constexpr double step = 1e-5;
    const auto gradient = TypeParam::gradient(inside);
    for (int j = 0; j < 3; ++j) {
        const Vec3 h = step * Vec3::Unit(j);
        const auto slope = ((TypeParam::shape(inside + h) - TypeParam::shape(inside - h)) / (2 * step)).eval();
        EXPECT_LT((gradient.col(j) - slope).norm(), difference) << "direction " << j;
    }
}

TYPED_TEST(ReferenceElementTest, QuadratureIntegratesOneAndEveryShapeFunction) {
    double volume = 0;
    typename TypeParam::Shape integral = TypeParam::Shape::Zero();
    for (const auto& [xi, weight] : TypeParam::quadrature()) {
        volume += weight;
        integral += weight * TypeParam::shape(xi);
    }
    EXPECT_NEAR(volume, Facts<TypeParam>::volume, round_off);
    typename TypeParam::Shape share = TypeParam::Shape::Constant(Facts<TypeParam>::volume / TypeParam::nodes);
    if constexpr (TypeParam::nodes == 10) share << Vector::Constant(4, -1.0 / 120), Vector::Constant(6, 1.0 / 30);
    EXPECT_LT((integral - share).norm(), round_off);
}

TYPED_TEST(ReferenceElementTest, MassQuadratureIsExactForProductsOfTwoShapeFunctions) {
    // against a tensor product of Gauss points, exact far beyond the degree needed
    constexpr std::array<double, 5> x{-0.906179845938664, -0.538469310105683, 0, 0.538469310105683, 0.906179845938664};
    constexpr std::array<double, 5> w{0.236926885056189, 0.478628670499366, 0.568888888888889, 0.478628670499366,
                                      0.236926885056189};
    constexpr int n = TypeParam::nodes;
    Matrix exact = Matrix::Zero(n, n), found = Matrix::Zero(n, n);
    for (std::size_t i = 0; i < 5; ++i)
        for (std::size_t j = 0; j < 5; ++j)
            for (std::size_t k = 0; k < 5; ++k) {
                Vec3 xi(x[i], x[j], x[k]);
                double weight = w[i] * w[j] * w[k];
                if (n != 8) { // collapse the cube onto the triangle, and on to the tetrahedron
                    const double u = (1 + x[i]) / 2, v = (1 + x[j]) / 2, t = (1 + x[k]) / 2;
                    xi = n == 6 ? Vec3(u, v * (1 - u), x[k]) : Vec3(u, v * (1 - u), t * (1 - u) * (1 - v));
                    weight *= n == 6 ? (1 - u) / 4 : (1 - u) * (1 - u) * (1 - v) / 8;
                }
                const Vector N = TypeParam::shape(xi);
                exact += weight * N * N.transpose();
            }
    for (const auto& [xi, weight] : TypeParam::mass_quadrature()) {
        EXPECT_GT(weight, 0);
        const Vector N = TypeParam::shape(xi);
        found += weight * N * N.transpose();
    }
    EXPECT_LT((found - exact).norm(), 10 * round_off); // the Gauss points above have fifteen digits
}

TEST(Wedge6, QuadratureIsExactToSecondDegreeInTheTriangleAndThirdAlongTheLine) {
    // integral of r^i s^j over the unit triangle is i! j! / (i + j + 2)!
    double rr = 0, rs = 0, tt_rr = 0, ttt = 0;
    for (const auto& [xi, weight] : Wedge6::quadrature()) {
        rr += weight * xi[0] * xi[0];
        rs += weight * xi[0] * xi[1];
        tt_rr += weight * xi[2] * xi[2] * xi[0] * xi[0];
        ttt += weight * xi[2] * xi[2] * xi[2];
    }
    EXPECT_NEAR(rr, 2 * 2.0 / 24, round_off);
    EXPECT_NEAR(rs, 2 * 1.0 / 24, round_off);
    EXPECT_NEAR(tt_rr, 2.0 / 3 * 2.0 / 24, round_off);
    EXPECT_NEAR(ttt, 0, round_off);
}

} // namespace
} // namespace osculate::fe
