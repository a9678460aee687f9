#include "element_cases.hpp"
#include "exact_rule.hpp"

namespace osculate::fe::fixtures::OSCULATE_THIS_FILE {
namespace {

constexpr double round_off = 1e-14;    // polynomials of degree three at most, arguments of order one
constexpr double exact_digits = 1e-13; // those of the exact rule's points
constexpr double difference = 1e-9;    // central differences of step 1e-5: error about step^2 times a third derivative
const Vec3 inside(0.21, 0.34, -0.17);  // a point without symmetry, inside every reference element but the tetrahedron

class EveryReferenceElement : public ::testing::TestWithParam<mesh::CellType> {};

TEST_P(EveryReferenceElement, HasTheNodesOfItsCellType) {
    with_element(GetParam(), [&]<class E>() { EXPECT_EQ(E::nodes, mesh::nodes_per_cell(GetParam())); });
}

TEST_P(EveryReferenceElement, HasItsMidsideNodesHalfWayAlongItsEdges) {
    const Eigen::Matrix3Xd c = reference_positions(GetParam());
    int middle = mesh::cell_info(GetParam()).corners();
    for (const auto& [a, b] : mesh::cell_info(GetParam()).edges)
        EXPECT_LT((c.col(middle++) - (c.col(a) + c.col(b)) / 2).norm(), round_off);
}

TEST_P(EveryReferenceElement, ContainsItsNodesAndWhatIsBetweenThemAlone) {
    constexpr double tolerance = 1e-9, little = 1e-8;
    with_element(GetParam(), [&]<class E>() {
        const typename E::Positions c = E::node_positions();
        const Vec3 middle = c.rowwise().mean();
        EXPECT_TRUE(E::contains(middle, 0));
        for (int a = 0; a < E::nodes; ++a) {
            EXPECT_TRUE(E::contains(c.col(a), tolerance));
            EXPECT_FALSE(E::contains(c.col(a) + little * (c.col(a) - middle), tolerance));
        }
        for (const mesh::LocalFace& face : mesh::cell_info(GetParam()).faces) { // through the middle of every face
            Vec3 centre = Vec3::Zero();
            for (int i = 0; i < face.count; ++i) centre += c.col(face.nodes[std::size_t(i)]) / face.count;
            EXPECT_TRUE(E::contains(centre, tolerance));
            EXPECT_FALSE(E::contains(centre + little * (centre - middle), tolerance / 10));
        }
        for (const QuadraturePoint& point : E::quadrature()) EXPECT_TRUE(E::contains(point.xi, 0));
        for (const QuadraturePoint& point : E::mass_quadrature()) EXPECT_TRUE(E::contains(point.xi, 0));
    });
}

TEST_P(EveryReferenceElement, ShapeFunctionsAreOneAtTheirNodeAndZeroAtTheOthers) {
    with_element(GetParam(), [&]<class E>() {
        const auto positions = E::node_positions();
        for (int b = 0; b < E::nodes; ++b) {
            const auto expected = E::Shape::Unit(b);
            EXPECT_LT((E::shape(positions.col(b)) - expected).norm(), round_off) << "node " << b;
        }
    });
}

TEST_P(EveryReferenceElement, ShapeFunctionsReproduceOneAndTheCoordinates) {
    with_element(GetParam(), [&]<class E>() {
        const auto N = E::shape(inside);
        EXPECT_NEAR(N.sum(), 1, round_off);
        EXPECT_LT((E::node_positions() * N - inside).norm(), round_off);
    });
}

TEST_P(EveryReferenceElement, GradientIsTheDerivativeOfTheShapeFunctions) {
    constexpr double step = 1e-5;
    with_element(GetParam(), [&]<class E>() {
        const auto gradient = E::gradient(inside);
        for (int j = 0; j < 3; ++j) {
            const Vec3 h = step * Vec3::Unit(j);
            const auto slope = ((E::shape(inside + h) - E::shape(inside - h)) / (2 * step)).eval();
            EXPECT_LT((gradient.col(j) - slope).norm(), difference) << "direction " << j;
        }
    });
}

TEST_P(EveryReferenceElement, QuadratureIntegratesOneAndEveryShapeFunction) {
    with_element(GetParam(), [&]<class E>() {
        typename E::Shape exact = E::Shape::Zero(), found = E::Shape::Zero();
        for (const auto& [xi, weight] : exact_rule<E>()) exact += weight * E::shape(xi);
        for (const auto& [xi, weight] : E::quadrature()) found += weight * E::shape(xi);
        EXPECT_LT((found - exact).norm(), exact_digits);
    });
}

TEST_P(EveryReferenceElement, MassQuadratureIsExactForProductsOfTwoShapeFunctions) {
    with_element(GetParam(), [&]<class E>() {
        Matrix exact = Matrix::Zero(E::nodes, E::nodes), found = exact;
        for (const auto& [xi, weight] : exact_rule<E>()) exact += weight * E::shape(xi) * E::shape(xi).transpose();
        for (const auto& [xi, weight] : E::mass_quadrature()) {
            EXPECT_GT(weight, 0);
            found += weight * E::shape(xi) * E::shape(xi).transpose();
        }
        EXPECT_LT((found - exact).norm(), exact_digits);
    });
}

INSTANTIATE_TEST_SUITE_P(Every, EveryReferenceElement, ::testing::ValuesIn(all_types()),
                         [](const auto& type) { return std::string(mesh::cell_info(type.param).name); });

/// Volumes of a cube of edge 2, a wedge and a tetrahedron.
TEST(ReferenceElements, HaveTheVolumesOfTheirQuadrature) {
    const auto volume = [](const auto& rule) {
        double sum = 0;
        for (const auto& [xi, weight] : rule) sum += weight;
        return sum;
    };
    EXPECT_NEAR(volume(Hex8::quadrature()), 8, round_off);
    EXPECT_NEAR(volume(Wedge6::quadrature()), 1, round_off);
    EXPECT_NEAR(volume(Wedge15::quadrature()), 1, round_off);
    EXPECT_NEAR(volume(Wedge15::mass_quadrature()), 1, round_off);
    EXPECT_NEAR(volume(Tet4::quadrature()), 1.0 / 6, round_off);
    EXPECT_NEAR(volume(Tet10::quadrature()), 1.0 / 6, round_off);
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

TEST(Wedge15, MassQuadratureIsExactToFourthDegreeInTheTriangleAndFifthAlongTheLine) {
    double rrss = 0, rrrr_tttt = 0, ttttt = 0;
    for (const auto& [xi, weight] : Wedge15::mass_quadrature()) {
        rrss += weight * std::pow(xi[0] * xi[1], 2);
        rrrr_tttt += weight * std::pow(xi[0] * xi[2], 4);
        ttttt += weight * std::pow(xi[2], 5);
    }
    EXPECT_NEAR(rrss, 2 * 4.0 / 720, round_off);
    EXPECT_NEAR(rrrr_tttt, 2.0 / 5 * 24 / 720, round_off);
    EXPECT_NEAR(ttttt, 0, round_off);
}

} // namespace
} // namespace osculate::fe::fixtures::OSCULATE_THIS_FILE
