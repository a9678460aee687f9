/// The vertex gap blend on half-tube, spheres, torus and saddle: smooth over all edges, found everywhere, exact, balanced.

#include "blend_surfaces.hpp"

#include <gtest/gtest.h>
#include <limits>
#include <string>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

using namespace fixtures;
using osculate::support::Random;

/// Weights of patches come with machine epsilon times their condition of about 1e5.
constexpr double patch_round_off = 1e-10;
/// The same sums of the same patches: no more than the order of additions may differ.
constexpr double same_point = 1e-12;

/// OSCULATE_FULL=1: a million samples and ten thousand paths over the five surfaces.
const int samples = full() ? 200'000 : 2'000; ///< a surface; there are five
const int paths = full() ? 2'000 : 60;

struct Body {
    const char* name;
    std::function<Surface()> make;
    std::function<Vec3(const Vec3&)> normal; ///< of the exact surface, at a point on it or near it
    std::function<Vec3(const Vec3&)> onto;   ///< the exact surface, from near it
    std::function<bool(const Vec3&)> inner;  ///< half a facet and more off the boundary
    double mean_normal_error;                ///< rad; two to three times the measured one
};
void PrintTo(const Body& body, std::ostream* out) {
    *out << body.name;
}

std::vector<Body> bodies() {
    const auto closed = [](const Vec3&) { return true; };
    const auto radial = [](const Vec3& p) -> Vec3 { return p.normalized(); };
    const auto ring = [](const Vec3& p) -> Vec3 { return 3 * Vec3(p.x(), p.y(), 0).normalized(); };
    return {{"HalfTube", [] { return half_tube(); },
             [](const Vec3& p) -> Vec3 { return -Vec3(p.x(), 0, p.z()).normalized(); },
             [](const Vec3& p) -> Vec3 { return Vec3(0, p.y(), 0) + tube_radius * Vec3(p.x(), 0, p.z()).normalized(); },
             [](const Vec3& p) { return p.z() < -0.4 && p.y() > 0.5 && p.y() < tube_length - 0.5; }, 1e-3},
            {"Sphere", [] { return icosphere(3).surface("Sphere"); }, radial, radial, closed, 3e-4},
            {"HybridSphere", [] { return hybrid_sphere(8).surface("HybridSphere"); }, radial, radial, closed, 3e-4},
            {"Torus", [] { return torus(40, 14).surface("Torus"); },
             [ring](const Vec3& p) -> Vec3 { return (p - ring(p)).normalized(); },
             [ring](const Vec3& p) -> Vec3 { return ring(p) + (p - ring(p)).normalized(); }, closed,
             6e-3}, // 26 degrees a facet
            {"Saddle", [] { return saddle(14).surface("Saddle"); },
             [](const Vec3& p) -> Vec3 { return Vec3(-0.3 * p.x(), 0.2 * p.y(), 1).normalized(); },
             [](const Vec3& p) -> Vec3 {
                 return {p.x(), p.y(), saddle_height(p.x(), p.y())};
             },
             [](const Vec3& p) { return std::max(std::abs(p.x()), std::abs(p.y())) < 1.8; }, 1e-3}};
}

class OnBlend : public ::testing::TestWithParam<Body> {
protected:
    Blend blend{GetParam().make()};
    const mesh::HalfEdgeSurface& topology = blend.surface.topology;
    Random random{41};

    /// A random point of a facet of the undeformed surface, bilinear or linear, and the facet's size.
    std::pair<Vec3, double> on_facet() {
        for (;;) {
            const auto f =
                std::min(static_cast<Index>(random.uniform(0, 1) * topology.facet_count()), topology.facet_count() - 1);
            const auto v = topology.facet_vertices(f);
            double a = random.uniform(0, 1), b = random.uniform(0, 1);
            if (v.size() == 3 && a + b > 1) a = 1 - a, b = 1 - b;
            const auto& x = blend.x;
            const Vec3 p = v.size() == 3 ? Vec3((1 - a - b) * x[v[0]] + a * x[v[1]] + b * x[v[2]])
                                         : Vec3((1 - a) * (1 - b) * x[v[0]] + a * (1 - b) * x[v[1]] + a * b * x[v[2]] +
                                                (1 - a) * b * x[v[3]]);
            if (GetParam().inner(p)) return {p, topology.facet_size(f)};
        }
    }
    /// A slave point within 0.3 facet sizes of it.
    Vec3 slave() {
        const auto [p, size] = on_facet();
        return p + 0.3 * random.uniform() * size * GetParam().normal(p);
    }
    void shake() {
        const double size = topology.mean_facet_size();
        blend.move([&](const Vec3& X) -> Vec3 { return X + random.vector(0.03 * size); });
    }
};

TEST_P(OnBlend, PassesThroughEveryVertex) {
    double worst = 0; // of the facet size
    for (const bool deformed : {false, true}) {
        if (deformed) shake();
        for (Index v = 0; v < topology.vertex_count(); ++v) {
            const ContactPoint point = blend.at(blend.x[v]);
            ASSERT_TRUE(point.found) << "vertex " << v;
            worst = std::max(worst, std::abs(point.gap) / topology.mean_facet_size());
        }
    }
    record("gap_at_vertices", worst);
    EXPECT_LT(worst, 1e-11);
}

TEST_P(OnBlend, NeedsNoFallbackHere) {
    EXPECT_EQ(blend.master->fallbacks(), 0);
}

TEST_P(OnBlend, IsFoundEverywhere) {
    shake();
    int lost = 0;
    for (int i = 0; i < samples; ++i)
        if (!blend.at(slave()).found) ++lost;
    record("points", samples);
    record("uncovered", lost);
    EXPECT_EQ(lost, 0);
}

TEST_P(OnBlend, UsesOnlyVerticesItAnnounces) {
    for (int i = 0; i < 200; ++i) {
        const ContactPoint point = blend.at(slave());
        ASSERT_TRUE(point.found);
        const auto announced = blend.master->patch_vertices(point.facet);
        EXPECT_TRUE(std::includes(announced.begin(), announced.end(), point.nodes.begin(), point.nodes.end()));
    }
}

/// Where the closest facet changes along a path, both facets give the same gap, normal, weights and forces, and the same
/// variations: nothing depends on the facet.
TEST_P(OnBlend, DoesNotJumpWhereTheClosestFacetChanges) {
    shake();
    int changes = 0, left = 0;
    double gap = 0, normal = 0, weights = 0, variation = 0;
    const double size = topology.mean_facet_size();
    for (int path = 0; path < paths; ++path) {
        const Vec3 from = slave(), n = GetParam().normal(from);
        const Vec3 along = 3 * size * (random.direction().cross(n)).normalized();
        const auto on_path = [&](double t) -> Vec3 { return from + t * along; };
        const int steps = 30;
        for (int i = 0; i < steps; ++i) {
            double low = double(i) / steps, high = double(i + 1) / steps;
            const Index before = blend.search.global(on_path(low), blend.x).facet;
            const Index after = blend.search.global(on_path(high), blend.x).facet;
            if (before == after || !GetParam().inner(on_path(high))) continue;
            Index other = after;
            while (high - low > 1e-14) { // to where the change happens
                const double middle = (low + high) / 2;
                const Index here = blend.search.global(on_path(middle), blend.x).facet;
                (here == before ? low : high) = middle;
                if (here != before) other = here;
                if (middle == low && middle == high) break;
            }
            const Vec3 s = on_path(high);
            if (!GetParam().inner(s)) continue;
            ContactVariation va, vb;
            const ContactPoint a = blend.at(s, blend.search.closest_on(before, s, blend.x), &va);
            const ContactPoint b = blend.at(s, blend.search.closest_on(other, s, blend.x), &vb);
            if (!a.found && !b.found) { // the path has left the surface's neighbourhood
                ++left;
                continue;
            }
            ASSERT_TRUE(a.found && b.found);
            ASSERT_EQ(a.nodes, b.nodes);
            ++changes;
            gap = std::max(gap, std::abs(a.gap - b.gap) / size);
            normal = std::max(normal, (a.normal - b.normal).norm());
            weights = std::max({weights, (a.weights - b.weights).norm(), (a.pressing - b.pressing).norm()});
            variation = std::max(variation, (va.dn - vb.dn).norm() / va.dn.norm());
        }
    }
    record("paths", paths);
    record("facet_changes", changes);
    record("changes_out_of_reach", left);
    record("gap_jump", gap);
    record("normal_jump", normal);
    record("weights_jump", weights);
    record("variation_jump", variation);
    EXPECT_GT(changes, paths);
    EXPECT_LT(left, changes / 100);
    EXPECT_LT(gap, same_point);
    EXPECT_LT(normal, same_point);
    EXPECT_LT(weights, same_point);
    EXPECT_LT(variation, same_point);
}

/// Along a path nothing jumps at all, wherever bumps begin and end: gap, normal and the normal's derivative change by no
/// more than a step times a bound on their slopes. The bumps are C2, so dn is continuous but has kinks.
TEST_P(OnBlend, IsContinuousAlongPaths) {
    shake();
    const double size = topology.mean_facet_size(), step = 1e-3 * size;
    // bounds on what a step may change, per facet size of way; a lost or a new patch would change far more in a step
    double worst_gap = 0, worst_normal = 0, worst_slope = 0;
    for (int path = 0; path < paths / 20; ++path) {
        const Vec3 from = slave(), n = GetParam().normal(from);
        const Vec3 along = step * (random.direction().cross(n)).normalized();
        ContactVariation before, after;
        ContactPoint last;
        for (int i = 0; i < 400; ++i) {
            const Vec3 s = from + i * along;
            if (!GetParam().inner(s)) break;
            const ContactPoint point = blend.at(s, &after);
            if (std::abs(point.gap) > 0.3 * size) break;
            ASSERT_TRUE(point.found);
            if (last.found) {
                const Vec3 grad = 0.5 * (before.dg.leftCols<3>() + after.dg.leftCols<3>()).transpose();
                worst_gap = std::max(worst_gap, std::abs(point.gap - last.gap - grad.dot(along)));
                worst_normal =
                    std::max(worst_normal, (point.normal - last.normal - before.dn.leftCols<3>() * along).norm());
                worst_slope = std::max(worst_slope, size * (after.dn.leftCols<3>() - before.dn.leftCols<3>()).norm());
            }
            last = point;
            std::swap(before, after);
        }
    }
    record("gap_off_its_slope", worst_gap / size);
    record("normal_off_its_slope", worst_normal);
    record("slope_change", worst_slope);
    // measured 5e-11, 4e-7 and 7e-4 of what one facet size is; the last two are true changes over a step
    EXPECT_LT(worst_gap, 1e-9 * size);
    EXPECT_LT(worst_normal, 2e-6);
    EXPECT_LT(worst_slope, 3e-3);
}

/// Derivatives along a random motion of slave and master nodes.
TEST_P(OnBlend, HasExactVariations) {
    const double size = topology.mean_facet_size();
    const double step = 3e-5 * size, tolerance = 1e-7;
    shake();
    double dg = 0, dn = 0, dweights = 0, dpressing = 0;
    int compared = 0;
    const int variations = std::min(samples / 20, 2000);
    for (int i = 0; i < variations; ++i) {
        const Vec3 s = slave(), ds = random.vector();
        const FacetHit hit = blend.search.global(s, blend.x);
        ContactVariation v;
        const ContactPoint point = blend.at(s, hit, &v);
        ASSERT_TRUE(point.found);
        Vector dy(v.dg.cols());
        dy.head<3>() = ds;
        for (Index k = 3; k < dy.size(); k += 3) dy.segment<3>(k) = random.vector();
        const std::vector<Vec3> x = blend.x;
        const auto moved = [&](double t) {
            for (std::size_t k = 0; k < point.nodes.size(); ++k)
                blend.x[point.nodes[k]] = x[point.nodes[k]] + t * dy.segment<3>(3 + 3 * static_cast<Index>(k));
            ContactPoint there = blend.at(s + t * ds, hit);
            blend.x = x;
            return there;
        };
        const ContactPoint plus = moved(step), minus = moved(-step);
        // a bump that ends within the step takes its patch's nodes, whose weights are then 1e-14, out of the list
        if (plus.nodes != point.nodes || minus.nodes != point.nodes) continue;
        ++compared;
        const double width = 2 * step;
        const double way = dy.norm();
        const Vector dphi = v.dweights * dy;
        const MatrixX3 dp = (v.dpressing * dy).reshaped(3, dphi.size()).transpose();
        const auto error = [&](const auto& here, const auto& differences, const auto& derivative) {
            return (here - differences / width).norm() / (derivative.norm() * way);
        };
        const Eigen::Matrix<double, 1, 1> here(v.dg.dot(dy)), differences(plus.gap - minus.gap);
        dg = std::max(dg, error(here, differences, v.dg));
        dn = std::max(dn, error(v.dn * dy, plus.normal - minus.normal, v.dn));
        dweights = std::max(dweights, error(dphi, plus.weights - minus.weights, v.dweights));
        dpressing = std::max(dpressing, error(dp, plus.pressing - minus.pressing, v.dpressing));
    }
    record("compared", compared);
    record("gap_gradient", dg);
    record("normal_gradient", dn);
    record("weights_gradient", dweights);
    record("pressing_gradient", dpressing);
    EXPECT_GT(compared, 9 * variations / 10);
    EXPECT_LT(dg, tolerance);
    EXPECT_LT(dn, tolerance);
    EXPECT_LT(dweights, tolerance);
    EXPECT_LT(dpressing, tolerance);
}

TEST_P(OnBlend, GivesTheProductsOfItsVariationsWithoutTheMatrices) {
    constexpr double round_off = 1e-12; // of a sum over some fifty nodes, of the largest entry
    shake();
    for (int i = 0; i < 50; ++i) {
        const Vec3 s = slave();
        const FacetHit hit = blend.search.global(s, blend.x);
        ContactVariation full, products;
        products.form = VariationForm::products;
        const ContactPoint point = blend.at(s, hit, &full), same = blend.at(s, hit, &products);
        ASSERT_TRUE(point.found);
        ASSERT_EQ(point.gap, same.gap);
        EXPECT_EQ(full.dg, products.dg);
        EXPECT_EQ(full.dn, products.dn);
        Vector dy(full.dg.cols()), weights, pressing;
        for (Index k = 0; k < dy.size(); ++k) dy(k) = random.uniform();
        products.along(same, dy, weights, pressing);
        EXPECT_LT((weights - full.dweights * dy).cwiseAbs().maxCoeff(),
                  round_off * full.dweights.cwiseAbs().maxCoeff());
        EXPECT_LT((pressing - full.dpressing * dy).cwiseAbs().maxCoeff(),
                  round_off * full.dpressing.cwiseAbs().maxCoeff());
        const Eigen::Matrix3Xd m = Eigen::Matrix3Xd::Random(3, point.weights.size());
        Matrix sums;
        products.weights_times(same, m, sums);
        EXPECT_LT((sums - m * full.dweights).cwiseAbs().maxCoeff(),
                  round_off * full.dweights.cwiseAbs().maxCoeff() * m.cwiseAbs().rowwise().sum().maxCoeff());
    }
}

/// A unit normal force on the slave and p_i on the masters: no resultant and no moment.
TEST_P(OnBlend, BalancesForceAndMoment) {
    shake();
    double force = 0, moment = 0, weights = 0;
    for (int i = 0; i < samples; ++i) {
        const Vec3 s = slave();
        const ContactPoint point = blend.at(s);
        ASSERT_TRUE(point.found);
        weights = std::max(weights, std::abs(point.weights.sum() - 1));
        Vec3 f = point.normal, m = Vec3::Zero();
        double forces = 1, reach = 0;
        for (std::size_t k = 0; k < point.nodes.size(); ++k) {
            const Vec3 p = point.pressing.row(static_cast<Index>(k)).transpose(), arm = blend.x[point.nodes[k]] - s;
            f += p;
            m += arm.cross(p);
            forces += p.norm();
            reach = std::max(reach, arm.norm());
        }
        force = std::max(force, f.norm() / forces);
        moment = std::max(moment, m.norm() / (forces * reach));
    }
    record("force", force);
    record("moment", moment);
    record("sum_of_weights", weights);
    EXPECT_LT(force, 1e-12);
    EXPECT_LT(moment, 1e-12);
    EXPECT_LT(weights, patch_round_off);
}

TEST_P(OnBlend, HasTheNormalOfTheExactSurface) {
    double sum = 0, worst = 0;
    for (int i = 0; i < samples; ++i) {
        const Vec3 p = GetParam().onto(on_facet().first), n = GetParam().normal(p);
        const ContactPoint point = blend.at(p);
        ASSERT_TRUE(point.found);
        const double angle = std::atan2(point.normal.cross(n).norm(), point.normal.dot(n));
        sum += angle;
        worst = std::max(worst, angle);
    }
    record("mean_normal_error", sum / samples);
    record("largest_normal_error", worst);
    EXPECT_LT(sum / samples, GetParam().mean_normal_error);
    EXPECT_LT(worst, 5 * GetParam().mean_normal_error); // next to one-sided patches, where there is a boundary
}

INSTANTIATE_TEST_SUITE_P(Of, OnBlend, ::testing::ValuesIn(bodies()),
                         [](const auto& tested) { return tested.param.name; });

/// Mean distance of the vertices of a surface to their nearest neighbours.
double spacing(const std::vector<Vec3>& x) {
    double sum = 0;
    for (const Vec3& a : x) {
        double nearest = std::numeric_limits<double>::max();
        for (const Vec3& b : x)
            if (&a != &b) nearest = std::min(nearest, (a - b).norm());
        sum += nearest;
    }
    return sum / static_cast<double>(x.size());
}

/// The sphere of the other tests is finer than the patches of rpim_reference.json; the half-tube is not.
TEST(BlendNormal, IsExactToAMilliradianOnMeshesAsCoarseAsTheReference) {
    constexpr double sphere_spacing = 1.289 / 5.1, tube_spacing = 0.772; // the coarsest patches there; radii 5.1 and 3
    ASSERT_GT(spacing(half_tube().x), tube_spacing);
    const Blend blend(hybrid_sphere(5).surface("HybridSphere"));
    ASSERT_GT(spacing(blend.x), sphere_spacing);
    double sum = 0;
    Random random(43);
    for (int i = 0; i < samples; ++i) {
        const Vec3 p = random.direction();
        const ContactPoint point = blend.at(p);
        ASSERT_TRUE(point.found);
        sum += std::atan2(point.normal.cross(p).norm(), point.normal.dot(p));
    }
    record("mean_normal_error", sum / samples);
    EXPECT_LT(sum / samples, 1e-3);
}

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
