/// RpimPatch against values computed in extended precision by an independent implementation.

#include "osculate/contact/projection.hpp"
#include "osculate/contact/rpim_patch.hpp"
#include "support/patch_checker.hpp"
#include "support/source_tree.hpp"

#include <algorithm>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

using nlohmann::json;

/// Both sides project in double precision and stop at 1e-11 of the node distance.
constexpr double projection_tolerance = 1e-10;
/// Second derivatives carry the largest round-off of a patch, and the shape operator multiplies two of them.
constexpr double curvature_tolerance = 1e-9;

const json& reference() {
    static const json data =
        json::parse(std::ifstream(support::source_tree() + "/tests/contact/data/rpim_reference.json"));
    return data;
}

/// A list of numbers, or of rows of numbers.
Matrix matrix(const json& j) {
    const bool rows = j.at(0).is_array();
    Matrix m(static_cast<Index>(j.size()), rows ? static_cast<Index>(j.at(0).size()) : 1);
    for (Index i = 0; i < m.rows(); ++i)
        for (Index k = 0; k < m.cols(); ++k) m(i, k) = (rows ? j[i][k] : j[i]).get<double>();
    return m;
}

/// Largest difference over the largest entry, the measure of the file's tolerances.
template <class A> double difference(const A& a, const json& j) {
    const Matrix b = matrix(j);
    return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

class Reference : public ::testing::TestWithParam<Index> {
protected:
    const json& c = reference().at("patches").at(GetParam());
    const double tolerance = c.at("tolerance");
    const MatrixX3 x = matrix(c.at("nodes"));
    const MatrixX2 u = matrix(c.at("natural_coordinates"));
    const std::optional<RpimPatch> patch = RpimPatch::fit(u, {c.at("R"), c.at("q")}, c.at("m_requested"));

    void SetUp() override { ASSERT_TRUE(patch); }
};

TEST_P(Reference, HasTheSameNodeDistance) {
    EXPECT_NEAR(patch->node_distance(), c.at("dc"), tolerance * c.at("dc").get<double>());
}

TEST_P(Reference, KeepsTheSamePolynomialTerms) {
    EXPECT_EQ(patch->polynomial_terms(), c.at("m_used").get<int>());
}

TEST_P(Reference, HasTheSameNaturalCoordinatesInItsFrame) {
    ReferencePlane plane;
    plane.origin = matrix(c.at("frame").at("origin"));
    plane.axes << matrix(c.at("frame").at("e1")), matrix(c.at("frame").at("e2"));
    MatrixX2 here(x.rows(), 2);
    for (Index i = 0; i < x.rows(); ++i) here.row(i) = plane.tangential(x.row(i).transpose()).transpose();
    EXPECT_LT(difference(here, c.at("natural_coordinates")), tolerance);
}

TEST_P(Reference, HasTheSameFrameFromItsFacet) {
    const auto corners = c.at("facet").get<std::vector<Index>>();
    const Vec3 origin = matrix(c.at("frame").at("origin"));
    const Vec3 e1 = matrix(c.at("frame").at("e1")), e2 = matrix(c.at("frame").at("e2"));
    Vec3 mean = Vec3::Zero();
    for (const Index corner : corners) mean += x.row(corner).transpose() / static_cast<double>(corners.size());
    EXPECT_LT((mean - origin).norm(), tolerance * origin.norm());
    const ReferencePlane plane = ReferencePlane::through(origin, e1.cross(e2));
    EXPECT_LT((plane.axes.col(0) - e1).norm(), tolerance);
    EXPECT_LT((plane.axes.col(1) - e2).norm(), tolerance);
}

TEST_P(Reference, HasTheSameWeightsAndDerivatives) {
    for (const json& e : c.at("evaluation")) {
        const Vec2 at = matrix(e.at("u"));
        const fixtures::Weights w = fixtures::weights_at(*patch, at);
        const MatrixX3 second = patch->second_derivatives(at);
        EXPECT_LT(difference(w.phi, e.at("Phi")), tolerance);
        EXPECT_LT(difference(w.phi_a.col(0), e.at("Phi_1")), tolerance);
        EXPECT_LT(difference(w.phi_a.col(1), e.at("Phi_2")), tolerance);
        EXPECT_LT(difference(second.col(0), e.at("Phi_11")), tolerance);
        EXPECT_LT(difference(second.col(1), e.at("Phi_12")), tolerance);
        EXPECT_LT(difference(second.col(2), e.at("Phi_22")), tolerance);
    }
}

TEST_P(Reference, HasTheSameSurface) {
    const MatrixX3 coefficients = patch->coefficients(x);
    for (const json& e : c.at("evaluation")) {
        const PatchPoint p = patch->point(matrix(e.at("u")), coefficients);
        EXPECT_LT(difference(p.X, e.at("X")), tolerance);
        EXPECT_LT(difference(p.X_a.col(0), e.at("X_1")), tolerance);
        EXPECT_LT(difference(p.X_a.col(1), e.at("X_2")), tolerance);
        EXPECT_LT(difference(p.normal(), e.at("normal")), tolerance);
        const Mat2 shape = (p.X_a.transpose() * p.X_a).inverse() * p.curvature(p.normal());
        EXPECT_NEAR(shape.trace() / 2, e.at("mean_curvature"), curvature_tolerance * shape.norm());
        EXPECT_NEAR(shape.determinant(), e.at("gauss_curvature"), curvature_tolerance * shape.squaredNorm());
    }
}

TEST_P(Reference, HasTheSameProjections) {
    const MatrixX3 coefficients = patch->coefficients(x);
    const double size = patch->node_distance();
    ASSERT_FALSE(c.at("projection").empty());
    for (const json& e : c.at("projection")) {
        ASSERT_TRUE(e.at("converged").get<bool>());
        const Vec3 s = matrix(e.at("s"));
        const auto foot = project(*patch, coefficients, s, Vec2::Zero());
        ASSERT_TRUE(foot);
        const Vec3 n = foot->point.normal();
        EXPECT_LT((foot->u - matrix(e.at("u"))).norm(), projection_tolerance * size);
        EXPECT_LT(difference(foot->point.X, e.at("X")), projection_tolerance);
        EXPECT_LT(difference(n, e.at("normal")), projection_tolerance);
        EXPECT_NEAR(n.dot(s - foot->point.X), e.at("gap"), projection_tolerance * size);
    }
}

INSTANTIATE_TEST_SUITE_P(Patches, Reference, ::testing::Range(Index{0}, Index{8}), [](const auto& tested) {
    std::string name = reference().at("patches").at(tested.param).at("name");
    std::replace(name.begin(), name.end(), '.', '_');
    return name;
});

TEST(ReferenceData, HoldsEightPatchesAndAFrozenOne) {
    EXPECT_EQ(reference().at("patches").size(), 8u);
    EXPECT_EQ(reference().at("frozen").size(), 1u);
}

TEST(FrozenPatch, FollowsItsNodesWithUnchangedWeights) {
    for (const json& c : reference().at("frozen")) {
        const auto patch = RpimPatch::fit(matrix(c.at("natural_coordinates")), {c.at("R"), c.at("q")}, c.at("m"));
        ASSERT_TRUE(patch);
        const MatrixX3 deformed = matrix(c.at("deformed_nodes"));
        const Vec3 s = matrix(c.at("s"));
        const auto foot = project(*patch, patch->coefficients(deformed), s, Vec2::Zero());
        ASSERT_TRUE(foot);
        const Vec3 n = foot->point.normal();
        EXPECT_LT((foot->u - matrix(c.at("u"))).norm(), projection_tolerance * patch->node_distance());
        EXPECT_LT(difference(foot->point.X, c.at("X")), projection_tolerance);
        EXPECT_LT(difference(n, c.at("normal")), projection_tolerance);
        EXPECT_NEAR(n.dot(s - foot->point.X), c.at("gap"), projection_tolerance * patch->node_distance());
    }
}

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
