#include "osculate/contact/facet_patch.hpp"
#include "osculate/contact/rpim_patch.hpp"
#include "support/patch_checker.hpp"
#include "support/random.hpp"

#include <gtest/gtest.h>
#include <string>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

using namespace fixtures;
using osculate::support::Random;

struct RpimCase {
    std::string name;
    Multiquadric basis;
    int m;
};

void PrintTo(const RpimCase& c, std::ostream* out) {
    *out << c.name;
}

/// A 5 x 5 grid shaken by a fifth of its spacing, far from the origin and in millimetre-like units: scaling must cope.
MatrixX2 shaken_grid(double spacing) {
    Random random(7);
    MatrixX2 u(25, 2);
    for (Index i = 0; i < 25; ++i)
        u.row(i) =
            spacing * Eigen::RowVector2d(10 + i % 5 + random.uniform(-0.2, 0.2), i / 5 - 7 + random.uniform(-0.2, 0.2));
    return u;
}

constexpr double spacing = 0.25;

PatchCase rpim_case() {
    PatchCase c{.nodes = shaken_grid(spacing),
                .samples = {},
                // cond(G) is below 1e6 for every basis here, most of it harmless: a thousandth of 1e6 machine epsilons
                .tolerance = 1e-9,
                // noise 1e-12 / 4e-4 and curvature (4e-4)^2 in node distances
                .difference_step = 1e-4,
                .difference_tolerance = 1e-5};
    const Vec2 centre = c.nodes.colwise().mean().transpose();
    Random random(8);
    for (int i = 0; i < 20; ++i)
        c.samples.push_back(centre + spacing * Vec2(random.uniform(-1.5, 1.5), random.uniform(-1.5, 1.5)));
    return c;
}

class Rpim : public ::testing::TestWithParam<RpimCase> {
protected:
    const PatchCase c = rpim_case();
    const std::optional<RpimPatch> patch = RpimPatch::fit(c.nodes, GetParam().basis, GetParam().m);

    void SetUp() override {
        ASSERT_TRUE(patch);
        ASSERT_EQ(patch->polynomial_terms(), GetParam().m);
    }
};

TEST_P(Rpim, PassesThroughEveryNode) {
    expect_interpolates_nodes(*patch, c);
}

TEST_P(Rpim, HasWeightsThatSumToOne) {
    expect_partition_of_unity(*patch, c);
}

TEST_P(Rpim, ReproducesItsPolynomials) {
    expect_reproduces(*patch, c, 1);
    if (GetParam().m == 6) expect_reproduces(*patch, c, 2);
}

TEST_P(Rpim, HasConsistentDerivatives) {
    Random random(9);
    MatrixX3 x(patch->size(), 3); // a plane with bumps
    for (Index i = 0; i < x.rows(); ++i) x.row(i) << c.nodes.row(i), 0.1 * random.uniform();
    expect_consistent_derivatives(*patch, c, x);
}

TEST_P(Rpim, HasConsistentSecondDerivativesOfTheWeights) {
    for (const Vec2& u : c.samples) {
        const MatrixX3 second = patch->second_derivatives(u);
        const Matrix differences = osculate::support::central_differences(
            [&](const Vector& at) -> Vector { return weights_at(*patch, at).phi_a.reshaped(); }, u, c.difference_step);
        Matrix written(2 * patch->size(), 2); // (Phi,1; Phi,2) by u1 and u2
        written << second.col(0), second.col(1), second.col(1), second.col(2);
        EXPECT_LT(osculate::support::relative_difference(written, differences), c.difference_tolerance);
    }
}

TEST_P(Rpim, DoesNotDependOnTheUnitOfLength) {
    const double scale = 1000;
    const auto scaled = RpimPatch::fit(scale * c.nodes, GetParam().basis, GetParam().m);
    ASSERT_TRUE(scaled);
    for (const Vec2& u : c.samples)
        EXPECT_LT((weights_at(*patch, u).phi - weights_at(*scaled, scale * u).phi).cwiseAbs().maxCoeff(), c.tolerance);
}

/// Else the forces on the nodes would lack in balance what the condition of the patch costs.
TEST_P(Rpim, HasResultantAndMomentsOfItsWeightsAndTheirSlopesToTheLastDigit) {
    const double last_digits = 1e-13; // sums of 25 weights, those of a quintic up to ten
    const Vec2 centre = c.nodes.colwise().mean().transpose();
    const MatrixX2 t = (c.nodes.rowwise() - centre.transpose()) / spacing;
    for (const Vec2& u : c.samples) {
        const Weights w = weights_at(*patch, u);
        EXPECT_NEAR(w.phi.sum(), 1, last_digits);
        EXPECT_LT((t.transpose() * w.phi - (u - centre) / spacing).norm(), last_digits);
        EXPECT_LT(spacing * w.phi_a.colwise().sum().norm(), last_digits);
        EXPECT_LT((spacing * t.transpose() * w.phi_a - Mat2::Identity()).norm(), last_digits);
    }
}

INSTANTIATE_TEST_SUITE_P(Bases, Rpim,
                         ::testing::Values(RpimCase{"Default", {}, 6}, RpimCase{"DefaultLinear", {}, 3},
                                           RpimCase{"Sharp", {1.0, 1.03}, 6},
                                           RpimCase{"HardyMultiquadric", {2.0, 0.5}, 6},
                                           RpimCase{"Cubic", {0.0, 1.5}, 6}, RpimCase{"CubicLinear", {0.0, 1.5}, 3},
                                           RpimCase{"Quintic", {0.0, 2.5}, 6}),
                         [](const auto& tested) { return tested.param.name; });

TEST(RpimPatch, FallsBackToAPlaneWithFewerThanSevenNodes) {
    const MatrixX2 six = shaken_grid(spacing).topRows(6);
    const auto patch = RpimPatch::fit(six, {}, 6);
    ASSERT_TRUE(patch);
    EXPECT_EQ(patch->polynomial_terms(), 3);
}

TEST(RpimPatch, FallsBackToAPlaneWithItsNodesOnACircle) {
    MatrixX2 circle(8, 2);
    for (Index i = 0; i < 8; ++i) circle.row(i) << std::cos(0.7 * i), std::sin(0.7 * i);
    const auto patch = RpimPatch::fit(circle, {}, 6);
    ASSERT_TRUE(patch);
    EXPECT_EQ(patch->polynomial_terms(), 3);
}

TEST(RpimPatch, TakesOfTheQuadraticsWhatNodesInTwoRowsDetermine) {
    for (const double angle : {0.0, 0.3, 1.2}) {
        const Eigen::Rotation2Dd turned(angle);
        MatrixX2 u(10, 2);
        for (Index i = 0; i < 10; ++i)
            u.row(i) = (turned * Vec2(1.3 * static_cast<double>(i / 2) + 5, i % 2)).transpose();
        EXPECT_EQ(RpimPatch::fit(u, {}, 6)->polynomial_terms(), 3);
        // the rows look bent in coordinates of equal length
        MatrixX2 bent = u;
        for (Index i = 1; i < 10; i += 2) bent.row(i) *= 1 + 1e-3 * static_cast<double>(i);
        const auto patch = RpimPatch::fit(bent, u, {}, basis_for(0.1), 6);
        ASSERT_TRUE(patch);
        EXPECT_EQ(patch->polynomial_terms(), 5);
        const auto exact = RpimPatch::fit(u, u, {}, basis_for(0.1), 6);
        const auto along = [&](const Vec2& at) { return (turned.inverse() * at).x(); };
        MatrixX3 x(10, 3);
        for (Index i = 0; i < 10; ++i) {
            const Vec2 at = u.row(i).transpose();
            x.row(i) << at.transpose(), along(at) * along(at);
        }
        const Vec2 middle = turned * Vec2(7.1, 0.4);
        const Vec3 point = exact->point(middle, exact->coefficients(x)).X;
        EXPECT_LT((point - Vec3(middle.x(), middle.y(), 7.1 * 7.1)).norm(), 1e-10)
            << "quadratics along the rows are exact";
    }
}

TEST(RpimPatch, RefusesNodesOnALine) {
    MatrixX2 line(7, 2);
    for (Index i = 0; i < 7; ++i) line.row(i) << i, 2 * i;
    EXPECT_FALSE(RpimPatch::fit(line, {}, 6));
}

TEST(RpimPatch, RefusesTwoNodes) {
    EXPECT_FALSE(RpimPatch::fit(MatrixX2::Identity(2, 2), {}, 3));
}

TEST(RpimPatch, RefusesCoincidentNodes) {
    MatrixX2 u = shaken_grid(spacing);
    u.row(3) = u.row(4);
    EXPECT_FALSE(RpimPatch::fit(u, {}, 6));
}

/// Corners of the reference square and triangle.
MatrixX2 corners(int count) {
    MatrixX2 u(count, 2);
    if (count == 4)
        u << -1, -1, 1, -1, 1, 1, -1, 1;
    else
        u << 0, 0, 1, 0, 0, 1;
    return u;
}

class Facet : public ::testing::TestWithParam<int> {
protected:
    const FacetPatch patch{GetParam()};
    // exact polynomials of degree two at most: round-off alone, over the step in differences
    const PatchCase c{.nodes = corners(GetParam()),
                      .samples = {{0.2, 0.3}, {0.6, 0.1}, {-0.4, 0.7}, {1.3, -1.2}},
                      .tolerance = 1e-14,
                      .difference_step = 1e-3,
                      .difference_tolerance = 1e-11};
};

TEST_P(Facet, PassesThroughEveryCorner) {
    expect_interpolates_nodes(patch, c);
}

TEST_P(Facet, HasWeightsThatSumToOne) {
    expect_partition_of_unity(patch, c);
}

TEST_P(Facet, ReproducesLinearFields) {
    expect_reproduces(patch, c, 1);
}

TEST_P(Facet, HasConsistentDerivatives) {
    Random random(3);
    MatrixX3 x(patch.size(), 3);
    for (Index i = 0; i < x.rows(); ++i) x.row(i) = random.vector().transpose();
    expect_consistent_derivatives(patch, c, x);
}

TEST_P(Facet, HasTheMeanOfItsCornersAtItsCentre) {
    const Vector phi = weights_at(patch, patch.centre()).phi;
    EXPECT_LT((phi.array() - 1.0 / GetParam()).abs().maxCoeff(), c.tolerance);
}

TEST_P(Facet, HasItsNormalToTheLeftOfItsCorners) {
    MatrixX3 flat(patch.size(), 3); // counter-clockwise seen from above
    flat << c.nodes, Vector::Zero(patch.size());
    EXPECT_LT((patch.point(patch.centre(), flat).normal() - Vec3::UnitZ()).norm(), c.tolerance);
}

INSTANTIATE_TEST_SUITE_P(Corners, Facet, ::testing::Values(3, 4),
                         [](const auto& tested) { return tested.param == 3 ? "Triangle" : "Quadrilateral"; });

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
