/// The vertex gap blend against values computed by an independent implementation.

#include "../../src/contact/vertex_patch.hpp"
#include "blend_surfaces.hpp"
#include "osculate/contact/projection.hpp"
#include "support/source_tree.hpp"

#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

using namespace fixtures;
using nlohmann::json;

const json& reference() {
    static const json data =
        json::parse(std::ifstream(support::source_tree() + "/tests/contact/data/vertex_gap_blend.json"));
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

/// Largest difference over the largest entry, the measure of the file's tolerance.
template <class A> double difference(const A& a, const json& j) {
    const Matrix b = matrix(j);
    return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

Shell shell() {
    Shell s;
    for (const json& node : reference().at("nodes")) s.x.emplace_back(matrix(node));
    for (const json& facet : reference().at("facets")) s.facets.push_back(facet.get<std::vector<Index>>());
    return s;
}

class BlendReference : public ::testing::Test {
protected:
    const json& r = reference();
    const double tolerance = r.at("tolerance");
    const BlendOptions options{.level = r.at("min_level"),
                               .basis = Multiquadric{r.at("R"), r.at("q")},
                               .polynomial_terms = r.at("m"),
                               .coordinates = PatchCoordinates::equal_length};
    const Blend blend{shell().surface("Reference"), options};
    const std::vector<VertexPatchInfo> patches = vertex_patches(blend.surface.topology, blend.surface.x, options);

    void SetUp() override { ASSERT_EQ(patches.size(), r.at("levels").size()); }
};

TEST_F(BlendReference, GrowsTheSamePatches) {
    for (const VertexPatchInfo& patch : patches) {
        EXPECT_EQ(patch.level, r.at("levels").at(patch.vertex).get<int>()) << "vertex " << patch.vertex;
        auto nodes = r.at("patch_nodes").at(patch.vertex).get<std::vector<Index>>();
        std::sort(nodes.begin(), nodes.end());
        EXPECT_EQ(patch.vertices, nodes) << "vertex " << patch.vertex;
    }
}

/// The metric's entries belong to the frame, so they vouch for the frame too.
TEST_F(BlendReference, HasTheSameBumps) {
    for (const VertexPatchInfo& patch : patches) {
        EXPECT_NEAR(patch.kappa, r.at("kappa").at(patch.vertex).get<double>(), tolerance) << "vertex " << patch.vertex;
        EXPECT_LT(difference(patch.metric, r.at("metric").at(patch.vertex)), tolerance) << "vertex " << patch.vertex;
    }
}

/// One patch seen from s, the plain way.
struct Seen {
    Vec2 u = Vec2::Zero();
    Vec3 normal = Vec3::Zero(), dpsi = Vec3::Zero(); ///< dpsi = dpsi/ds
    double gap = 0, tau = 2, psi = 0;
};
Seen see(const VertexPatch& patch, const Vec3& s, const std::vector<Vec3>& x) {
    Seen seen;
    MatrixX3 nodes(static_cast<Index>(patch.vertices.size()), 3);
    for (Index i = 0; i < nodes.rows(); ++i) nodes.row(i) = x[patch.vertices[i]].transpose();
    const auto foot = project(patch.shape, patch.shape.coefficients(nodes), s, patch.origin);
    if (!foot) return seen;
    const PatchPoint& p = foot->point;
    seen.u = foot->u - patch.origin;
    seen.tau = patch.kappa * seen.u.dot(patch.metric * seen.u);
    seen.normal = p.normal();
    seen.gap = seen.normal.dot(s - p.X);
    if (seen.tau >= 1) return seen;
    const double rest = 1 - seen.tau;
    const Mat2 K = p.X_a.transpose() * p.X_a - seen.gap * p.curvature(seen.normal);
    seen.psi = rest * rest * rest;
    seen.dpsi = -6 * patch.kappa * rest * rest * p.X_a * K.inverse() * (patch.metric * seen.u);
    return seen;
}

TEST_F(BlendReference, SeesTheSameActivePatches) {
    const VertexPatches all(blend.surface.topology, blend.surface.x, options);
    for (const json& p : r.at("points")) {
        const Vec3 s = matrix(p.at("s"));
        EXPECT_EQ(blend.search.global(s, blend.x).facet, p.at("facet").get<Index>());
        std::vector<Index> active, expected;
        for (const VertexPatch& patch : all.patches) {
            const Seen seen = see(patch, s, blend.x);
            if (seen.psi == 0) continue;
            active.push_back(patch.vertex);
            for (const json& a : p.at("active")) {
                if (a.at("vertex").get<Index>() != patch.vertex) continue;
                EXPECT_LT(difference(seen.u, a.at("u")), tolerance);
                EXPECT_LT(difference(seen.normal, a.at("normal")), tolerance);
                EXPECT_NEAR(seen.gap, a.at("gap"), tolerance);
                EXPECT_NEAR(seen.tau, a.at("tau"), tolerance);
            }
        }
        for (const json& a : p.at("active")) expected.push_back(a.at("vertex").get<Index>());
        EXPECT_EQ(active, expected);
    }
}

TEST_F(BlendReference, HasTheSameGapAndGradients) {
    for (const json& p : r.at("points")) {
        ContactVariation variation;
        const ContactPoint point = blend.at(matrix(p.at("s")), &variation);
        ASSERT_TRUE(point.found);
        EXPECT_NEAR(point.gap, p.at("g"), tolerance);
        const Vec3 grad = variation.dg.leftCols<3>().transpose();
        EXPECT_LT(difference(grad, p.at("grad_s")), tolerance);
        EXPECT_LT((grad.normalized() - point.normal).norm(), tolerance);
        ASSERT_EQ(point.nodes, p.at("nodes").get<std::vector<Index>>());
        const Index n = point.pressing.rows();
        EXPECT_LT(difference(point.pressing * grad.norm(), p.at("grad_nodes")), tolerance);
        EXPECT_LT(difference(variation.dg.tail(3 * n).reshaped(3, n).transpose(), p.at("grad_nodes")), tolerance);
    }
}

/// The file's foot is the point of the surface g = 0 below s, and its normal the one there; ContactPoint's foot is where
/// the weights are taken, and its normal the gradient at s.
TEST_F(BlendReference, HasTheSameFootOnItsZeroSurface) {
    for (const json& p : r.at("points")) {
        const ContactPoint point = blend.at(matrix(p.at("foot")));
        ASSERT_TRUE(point.found);
        EXPECT_NEAR(point.gap, 0, tolerance);
        EXPECT_LT(difference(point.normal, p.at("normal")), tolerance);
    }
}

/// The file leaves out the last term of the second variation, (1/P) sum (g_v - g) dDpsi_v: 2 to 3 % of the block, taken
/// here from differences of dpsi. Of the sum, dn = (I - n n^T) H / |grad g| holds all but the part along n n^T.
TEST_F(BlendReference, HasTheSameSecondDerivative) {
    const VertexPatches all(blend.surface.topology, blend.surface.x, options);
    const double step = 2e-3; // of a sixth-order formula: its error and round-off are both near 1e-12
    for (const json& p : r.at("points")) {
        const Vec3 s = matrix(p.at("s"));
        ContactVariation variation;
        const ContactPoint point = blend.at(s, &variation);
        Mat3 last = Mat3::Zero();
        double P = 0;
        for (const VertexPatch& patch : all.patches) {
            const Seen seen = see(patch, s, blend.x);
            if (seen.psi == 0) continue;
            P += seen.psi;
            for (int k = 0; k < 3; ++k) {
                const auto slope = [&](int times) -> Vec3 {
                    const Vec3 d = times * step * Vec3::Unit(k);
                    return see(patch, s + d, blend.x).dpsi - see(patch, s - d, blend.x).dpsi;
                };
                last.col(k) += (seen.gap - point.gap) * (45 * slope(1) - 9 * slope(2) + slope(3)) / (60 * step);
            }
        }
        const Mat3 H = matrix(p.at("tangent_s_block")) + last / P;
        const Mat3 tangential = Mat3::Identity() - point.normal * point.normal.transpose();
        const Mat3 here = variation.dg.leftCols<3>().norm() * variation.dn.leftCols<3>();
        EXPECT_LT((here - tangential * H).cwiseAbs().maxCoeff(), tolerance * H.cwiseAbs().maxCoeff());
    }
}

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
