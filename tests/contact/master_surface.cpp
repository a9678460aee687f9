#include "osculate/contact/master_surface.hpp"

#include "osculate/contact/facet_patch.hpp"
#include "surfaces.hpp"

#include <gtest/gtest.h>
#include <numbers>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

using namespace fixtures;
using osculate::support::Random;

/// Weights of patches come with machine epsilon times their condition of about 1e5.
constexpr double patch_round_off = 1e-10;

struct MasterCase {
    std::string name;
    int surface; ///< of all_surfaces()
    bool smooth;
    RpimOptions options;
};

void PrintTo(const MasterCase& c, std::ostream* out) {
    *out << c.name;
}

std::vector<MasterCase> cases() {
    const char* bodies[] = {"HalfTube", "HalfTubeTet4", "Quadrilaterals", "Triangles", "Hybrid"};
    std::vector<MasterCase> all;
    for (int k = 0; k < 5; ++k) {
        const std::string body = bodies[k];
        all.push_back({"Facets" + body, k, false, {}});
        all.push_back({"Rpim" + body, k, true, {}});
        all.push_back({"RpimTangential" + body, k, true, {.coordinates = PatchCoordinates::tangential}});
        all.push_back(
            {"RpimOneRing" + body, k, true, {.ring = 1, .basis = Multiquadric{1.0, 1.03}, .polynomial_terms = 3}});
    }
    return all;
}

struct Master {
    explicit Master(Surface s) : surface(std::move(s)), search(surface.topology), x(surface.x) {}

    [[nodiscard]] ContactPoint at(const Vec3& s, ContactVariation* variation = nullptr) const {
        ContactPoint point;
        master->evaluate(s, search.global(s, x), x, point, variation);
        return point;
    }
    void move(const auto& f) {
        for (Vec3& p : x) p = f(p);
        search.build(x);
    }

    Surface surface;
    FacetSearch search;
    std::vector<Vec3> x; ///< current; surface.x stays the reference
    std::unique_ptr<MasterSurface> master;
};

std::unique_ptr<Master> make(Surface surface, bool smooth, const RpimOptions& options = {}) {
    auto m = std::make_unique<Master>(std::move(surface));
    m->master = smooth ? make_rpim_surface(m->surface.topology, m->surface.x, options)
                       : make_facets_surface(m->surface.topology);
    m->search.build(m->x);
    return m;
}

class OnMaster : public ::testing::TestWithParam<MasterCase> {
protected:
    const std::unique_ptr<Master> m =
        make(std::move(all_surfaces()[GetParam().surface]), GetParam().smooth, GetParam().options);

    /// Slave points over a random point of every fifth facet, at distances of up to a third of its size.
    [[nodiscard]] std::vector<Vec3> slaves() const {
        Random random(31);
        std::vector<Vec3> all;
        for (Index f = 0; f < m->surface.topology.facet_count(); f += 5) {
            const auto v = m->surface.topology.facet_vertices(f);
            MatrixX3 corners(static_cast<Index>(v.size()), 3);
            for (Index b = 0; b < corners.rows(); ++b) corners.row(b) = m->x[v[b]].transpose();
            const FacetPatch patch(static_cast<int>(v.size()));
            const PatchPoint p = patch.point(patch.centre() + 0.25 * Vec2(random.uniform(), random.uniform()), corners);
            all.push_back(p.X + 0.3 * random.uniform() * m->surface.topology.facet_size(f) * p.normal());
        }
        return all;
    }
};

TEST_P(OnMaster, PassesThroughEveryVertex) {
    for (Index v = 0; v < m->surface.topology.vertex_count(); ++v) {
        const ContactPoint point = m->at(m->x[v]);
        ASSERT_TRUE(point.found) << "vertex " << v;
        EXPECT_NEAR(point.gap, 0, patch_round_off) << "vertex " << v;
    }
}

TEST_P(OnMaster, NeedsNoFallbackHere) {
    EXPECT_EQ(m->master->fallbacks(), 0);
}

TEST_P(OnMaster, UsesThePatchItAnnounces) {
    for (const Vec3& s : slaves()) {
        const ContactPoint point = m->at(s);
        ASSERT_TRUE(point.found);
        const auto announced = m->master->patch_vertices(point.facet);
        EXPECT_EQ(point.nodes, std::vector<Index>(announced.begin(), announced.end()));
        const auto& topology = m->surface.topology;
        const auto facet = topology.facet_vertices(point.facet);
        EXPECT_EQ(point.nodes, GetParam().smooth ? topology.facet_ring(point.facet, GetParam().options.ring)
                                                 : std::vector<Index>(facet.begin(), facet.end()));
    }
}

TEST_P(OnMaster, MeasuresTheDistanceToItsFoot) {
    for (const Vec3& s : slaves()) {
        const ContactPoint point = m->at(s);
        ASSERT_TRUE(point.found);
        EXPECT_NEAR(point.normal.norm(), 1, patch_round_off);
        EXPECT_LT((s - point.foot - point.gap * point.normal).norm(), patch_round_off);
    }
}

/// A unit normal force on the slave and p_i on the masters: no resultant and no moment.
TEST_P(OnMaster, BalancesForceAndMoment) {
    Random random(32);
    m->move([&](const Vec3& X) -> Vec3 { return X + random.vector(0.02); });
    for (const Vec3& s : slaves()) {
        const ContactPoint point = m->at(s);
        ASSERT_TRUE(point.found);
        EXPECT_NEAR(point.weights.sum(), 1, patch_round_off);
        Vec3 force = point.normal, moment = s.cross(point.normal);
        for (std::size_t i = 0; i < point.nodes.size(); ++i) {
            const Vec3 on_master = point.pressing.row(static_cast<Index>(i)).transpose();
            force += on_master;
            moment += m->x[point.nodes[i]].cross(on_master);
        }
        EXPECT_LT(force.norm(), patch_round_off);
        EXPECT_LT(moment.norm(), 10 * patch_round_off); // arms of order ten
    }
}

TEST_P(OnMaster, HasVariationsThatVanishInRigidMotions) {
    Random random(33);
    m->move([&](const Vec3& X) -> Vec3 { return X + random.vector(0.02); });
    const double far = 10; // coordinates
    for (const Vec3& s : slaves()) {
        ContactVariation variation;
        const ContactPoint point = m->at(s, &variation);
        ASSERT_TRUE(point.found);
        const auto n = static_cast<Index>(point.nodes.size());
        for (int k = 0; k < 3; ++k) {
            Vector translation(3 + 3 * n), rotation(3 + 3 * n);
            translation << Vec3::Unit(k).replicate(n + 1, 1);
            rotation.head<3>() = Vec3::Unit(k).cross(s);
            for (Index i = 0; i < n; ++i) rotation.segment<3>(3 + 3 * i) = Vec3::Unit(k).cross(m->x[point.nodes[i]]);
            EXPECT_NEAR(variation.dg.dot(translation), 0, patch_round_off);
            EXPECT_NEAR(variation.dg.dot(rotation), 0, far * patch_round_off);
            EXPECT_LT((variation.dn * translation).norm(), patch_round_off);
            EXPECT_LT((variation.dn * rotation - Vec3::Unit(k).cross(point.normal)).norm(), far * patch_round_off);
            EXPECT_LT((variation.dweights * translation).norm(), patch_round_off);
            EXPECT_LT((variation.dweights * rotation).norm(), far * patch_round_off);
        }
    }
}

/// Everything about a point as a function of one parameter along a random motion of slave and master nodes.
TEST_P(OnMaster, HasExactVariations) {
    const double step = 1e-5;      // of motions of order one: round-off 1e-12 / 1e-5, curvature 1e-10
    const double tolerance = 1e-6; // with a margin for the third derivatives of strongly curved patches
    Random random(34);
    for (const Vec3& s : slaves()) {
        const FacetHit hit = m->search.global(s, m->x);
        const Vec3 ds = random.vector();
        std::vector<Vec3> dx;
        for (std::size_t i = 0; i < m->x.size(); ++i) dx.push_back(random.vector());
        const auto moved = [&](double t) {
            std::vector<Vec3> x = m->x;
            for (std::size_t i = 0; i < x.size(); ++i) x[i] += t * dx[i];
            ContactPoint point;
            m->master->evaluate(s + t * ds, hit, x, point);
            return point;
        };
        ContactVariation variation;
        ContactPoint point;
        m->master->evaluate(s, hit, m->x, point, &variation);
        const ContactPoint plus = moved(step), minus = moved(-step);
        ASSERT_TRUE(point.found && plus.found && minus.found);
        Vector dy(3 + 3 * static_cast<Index>(point.nodes.size()));
        dy.head<3>() = ds;
        for (std::size_t i = 0; i < point.nodes.size(); ++i)
            dy.segment<3>(3 + 3 * static_cast<Index>(i)) = dx[point.nodes[i]];
        EXPECT_NEAR(variation.dg.dot(dy), (plus.gap - minus.gap) / (2 * step), tolerance);
        EXPECT_LT((variation.dn * dy - (plus.normal - minus.normal) / (2 * step)).norm(),
                  tolerance * (1 + variation.dn.norm()));
        const Vector dphi = variation.dweights * dy;
        EXPECT_LT((dphi - (plus.weights - minus.weights) / (2 * step)).norm(),
                  tolerance * (1 + variation.dweights.norm()));
        const MatrixX3 dp = (variation.dpressing * dy).reshaped(3, dphi.size()).transpose();
        EXPECT_LT((dp - (plus.pressing - minus.pressing) / (2 * step)).norm(),
                  tolerance * (1 + variation.dpressing.norm()));
    }
}

TEST_P(OnMaster, TurnsWithTheBody) {
    const std::vector<Vec3> s = slaves();
    std::vector<ContactPoint> before;
    for (const Vec3& at : s) before.push_back(m->at(at));
    const Mat3 R = Eigen::AngleAxisd(2.1, Vec3(1, -2, 0.5).normalized()).toRotationMatrix();
    const Vec3 shift(4, -3, 7);
    m->move([&](const Vec3& X) -> Vec3 { return R * X + shift; });
    for (std::size_t i = 0; i < s.size(); ++i) {
        const ContactPoint after = m->at(R * s[i] + shift);
        ASSERT_TRUE(after.found);
        ASSERT_EQ(after.facet, before[i].facet);
        EXPECT_NEAR(after.gap, before[i].gap, patch_round_off);
        EXPECT_LT((after.normal - R * before[i].normal).norm(), patch_round_off);
        EXPECT_LT((after.weights - before[i].weights).norm(), 10 * patch_round_off); // feet's, times their slopes
    }
}

INSTANTIATE_TEST_SUITE_P(Of, OnMaster, ::testing::ValuesIn(cases()),
                         [](const auto& tested) { return tested.param.name; });

/// Worst angle between the normal and the cylinder's own, over points on the cylinder.
double normal_error(const Master& m, double from, double to) {
    Random random(35);
    double worst = 0;
    for (int i = 0; i < 500; ++i) {
        const double angle = std::numbers::pi * (1 + random.uniform(from, to));
        const Vec3 outward(std::cos(angle), 0, std::sin(angle));
        const ContactPoint point = m.at(tube_radius * outward + Vec3(0, tube_length * random.uniform(from, to), 0));
        EXPECT_TRUE(point.found);
        worst = std::max(worst, std::acos(std::min(1.0, -outward.dot(point.normal))));
    }
    return worst;
}

TEST(RpimSurface, HasFarBetterNormalsThanItsFacets) {
    const double facets = normal_error(*make(half_tube(), false), 0.02, 0.98);
    const double half_a_facet = std::numbers::pi / 24;
    EXPECT_NEAR(facets, half_a_facet, 0.05 * half_a_facet);
    const auto rpim = make(half_tube(), true);
    EXPECT_LT(normal_error(*rpim, 0.2, 0.8), 0.03 * facets);  // two rings on all sides: measured 0.021
    EXPECT_LT(normal_error(*rpim, 0.02, 0.98), 0.1 * facets); // one-sided ones included
}

class FlatMaster : public ::testing::TestWithParam<bool> {
protected:
    const std::unique_ptr<Master> m = make(block_top(mesh::BlockPattern::quad), GetParam()); // facets of size 0.5
};

TEST_P(FlatMaster, IsNotFoundBeyondItsBoundary) {
    for (const double height : {-0.1, 0.0, 0.2}) {
        EXPECT_TRUE(m->at({5.004, 2.1, height}).found) << "less than a hundredth of a facet beyond";
        EXPECT_FALSE(m->at({5.006, 2.1, height}).found);
        EXPECT_FALSE(m->at({5.004, 4.006, height}).found);
        EXPECT_FALSE(m->at({-1, -1, height}).found);
        EXPECT_TRUE(m->at({2.5, 2.1, height}).found); // on an inner edge
    }
}

TEST_P(FlatMaster, IsNotFoundFromDeepBehind) {
    const ContactPoint deep = m->at({2.2, 2.1, -0.9});
    EXPECT_TRUE(deep.found);
    EXPECT_FALSE(deep.behind);
    EXPECT_NEAR(deep.gap, -0.9, patch_round_off);
    const ContactPoint behind = m->at({2.2, 2.1, -1.1}); // two facet sizes are 1.0
    EXPECT_FALSE(behind.found);
    EXPECT_TRUE(behind.behind);
    EXPECT_NEAR(behind.gap, -1.1, patch_round_off);
    EXPECT_FALSE(m->at({5.1, 2.1, -1.1}).behind) << "beyond the boundary is not behind";
}

TEST_P(FlatMaster, IsNotFoundWithoutAFacet) {
    ContactPoint point;
    point.found = true;
    m->master->evaluate(Vec3::Zero(), FacetHit{}, m->x, point);
    EXPECT_FALSE(point.found);
}

TEST_P(FlatMaster, IsFlat) {
    Random random(36);
    for (int i = 0; i < 200; ++i) {
        const Vec3 s(random.uniform(0.1, 4.9), random.uniform(0.1, 3.9), random.uniform(-0.4, 0.4));
        const ContactPoint point = m->at(s);
        ASSERT_TRUE(point.found);
        EXPECT_NEAR(point.gap, s.z(), patch_round_off);
        EXPECT_LT((point.normal - Vec3::UnitZ()).norm(), patch_round_off);
    }
}

INSTANTIATE_TEST_SUITE_P(Of, FlatMaster, ::testing::Bool(),
                         [](const auto& tested) { return tested.param ? "Rpim" : "Facets"; });

TEST(HollowMaster, IsNotFoundNearItsAxis) {
    for (const bool smooth : {false, true}) {
        const auto m = make(half_tube(), smooth);
        const auto at = [&](double radius) { return m->at({0.05 * radius, 6.1, -radius}); };
        EXPECT_TRUE(at(0.25 * tube_radius).found);
        EXPECT_EQ(at(0.15 * tube_radius).found, !smooth) << "beyond 0.8 of the radius of curvature; facets have none";
    }
}

TEST(HollowMaster, FindsPenetrationInAFoldAtItsEnd) {
    for (const bool smooth : {false, true}) {
        const auto m = make(half_tube(), smooth); // the lowest line is an edge, and y = 0 the end
        for (const double depth : {0.01, 0.1, 0.3}) {
            EXPECT_TRUE(m->at({0, 0, -tube_radius - depth}).found) << depth;
            EXPECT_FALSE(m->at({0, -0.01, -tube_radius - depth}).found) << depth;
        }
    }
}

TEST(RpimSurface, TakesOneRingLessWhereItsPatchWouldOverlap) {
    const double no_features = std::numbers::pi;
    // three facets around turn by 60 degrees: seen from an end facet, the second ring is turned by 120
    const mesh::Mesh tube = mesh::make_half_tube(tube_radius, 1, tube_length, {3, 13, 1});
    const auto m = make(surface_of("Coarse", tube, "inner", no_features), true);
    EXPECT_EQ(m->master->fallbacks(), 2 * 13);
    int one_ring = 0;
    for (Index f = 0; f < m->surface.topology.facet_count(); ++f) {
        const auto patch = m->master->patch_vertices(f);
        const std::vector<Index> vertices(patch.begin(), patch.end());
        if (vertices == m->surface.topology.facet_ring(f, 1))
            ++one_ring;
        else
            EXPECT_EQ(vertices, m->surface.topology.facet_ring(f, 2));
    }
    EXPECT_EQ(one_ring, 2 * 13);
}

TEST(RpimSurface, TakesTheFacetWhereEvenOneRingWouldOverlap) {
    // two facets around turn by 90 degrees
    const mesh::Mesh tube = mesh::make_half_tube(tube_radius, 1, tube_length, {2, 13, 1});
    const auto m = make(surface_of("Coarsest", tube, "inner", std::numbers::pi), true);
    EXPECT_EQ(m->master->fallbacks(), m->surface.topology.facet_count());
    for (Index f = 0; f < m->surface.topology.facet_count(); ++f) EXPECT_EQ(m->master->patch_vertices(f).size(), 4u);
    const double apothem = tube_radius * std::cos(std::numbers::pi / 4);
    const Vec3 n = Vec3(-1, 0, -1).normalized();
    const ContactPoint point = m->at((apothem - 0.1) * n + Vec3(0, 6.1, 0));
    ASSERT_TRUE(point.found);
    EXPECT_NEAR(point.gap, 0.1, patch_round_off);
}

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
