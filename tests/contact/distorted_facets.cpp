/// Quadrilaterals that are no parallelograms, far past their corners: their bilinear maps fold over there.

#include "osculate/contact/facet_patch.hpp"
#include "osculate/contact/master_surface.hpp"
#include "support/random.hpp"

#include <cmath>
#include <gtest/gtest.h>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

using osculate::support::Random;

constexpr double round_off = 1e-12;

/// One facet, seen as if surfaces went on at all its edges.
struct OneFacet {
    explicit OneFacet(std::vector<Vec3> corners) : x(std::move(corners)) {
        mesh::Facet facet;
        facet.nodes = {0, 1, 2, 3};
        facet.count = 4;
        facet.block = facet.element = 0;
        topology = std::make_unique<mesh::HalfEdgeSurface>(std::vector{facet}, x, 1.0);
        master = make_facets_surface(*topology);
    }
    [[nodiscard]] ContactPoint at(const Vec3& s, ContactVariation* variation = nullptr) const {
        FacetHit hit = FacetSearch(*topology).closest_on(0, s, x);
        hit.boundary = false;
        hit.beyond = 0;
        ContactPoint point;
        master->evaluate(s, hit, x, point, variation);
        return point;
    }

    std::vector<Vec3> x;
    std::unique_ptr<mesh::HalfEdgeSurface> topology;
    std::unique_ptr<MasterSurface> master;
};

/// Its long edges would meet at y = 1/0.9.
std::vector<Vec3> trapezoid() {
    return {{0, 0, 0}, {1, 0, 0}, {0.55, 1, 0}, {0.45, 1, 0}};
}

/// Plane quadrilaterals with corners in all places that leave them convex.
std::vector<std::vector<Vec3>> convex(int count) {
    Random random(91);
    std::vector<std::vector<Vec3>> all;
    while (static_cast<int>(all.size()) < count) {
        std::vector<Vec3> x{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}};
        for (Vec3& corner : x) corner += Vec3(random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7), 0);
        bool good = true;
        for (std::size_t b = 0; b < 4; ++b)
            good = good && (x[(b + 1) % 4] - x[b]).cross(x[(b + 3) % 4] - x[b]).z() > 0.02;
        if (good) all.push_back(x);
    }
    return all;
}

TEST(DistortedFacet, KeepsItsSidesPastAShortEdge) {
    const OneFacet facet(trapezoid());
    for (const double y : {1.05, 1.1, 1.11, 1.2, 1.5, 2.0})
        for (const double gap : {0.01, -0.01, 0.0}) {
            const ContactPoint point = facet.at({0.52, y, gap});
            ASSERT_TRUE(point.found) << y;
            EXPECT_NEAR(point.gap, gap, round_off) << y;
            EXPECT_LT((point.normal - Vec3::UnitZ()).norm(), round_off) << y;
            EXPECT_LT((point.foot - Vec3(0.52, y, 0)).norm(), round_off) << y;
        }
}

TEST(DistortedFacet, IsAPlaneWhateverItsCorners) {
    Random random(92);
    for (const std::vector<Vec3>& x : convex(200)) {
        const OneFacet facet(x);
        for (int i = 0; i < 50; ++i) {
            const Vec3 s(random.uniform(-2, 3), random.uniform(-2, 3), random.uniform(-0.1, 0.1));
            const ContactPoint point = facet.at(s);
            ASSERT_TRUE(point.found) << s.transpose();
            EXPECT_NEAR(point.gap, s.z(), 100 * round_off);
            EXPECT_LT((point.normal - Vec3::UnitZ()).norm(), 100 * round_off);
            // forces on its nodes have the resultant and the moment of the force on the slave
            Vec3 centre = Vec3::Zero();
            for (std::size_t k = 0; k < 4; ++k) centre += point.weights(static_cast<Index>(k)) * x[k];
            EXPECT_NEAR(point.weights.sum(), 1, 100 * round_off);
            EXPECT_LT((centre - Vec3(s.x(), s.y(), 0)).norm(), 1000 * round_off);
        }
    }
}

/// Where it is a little warped, its normal turns a little.
TEST(DistortedFacet, DoesNotTurnRoundWhereItIsWarped) {
    Random random(93);
    for (std::vector<Vec3> x : convex(100)) {
        for (Vec3& corner : x) corner.z() = random.uniform(-0.01, 0.01);
        const OneFacet facet(x);
        const Vec3 N = (x[2] - x[0]).cross(x[3] - x[1]).normalized();
        for (int i = 0; i < 50; ++i) {
            const Vec3 s(random.uniform(-2, 3), random.uniform(-2, 3), random.uniform(-0.1, 0.1));
            const ContactPoint point = facet.at(s);
            if (point.found) {
                EXPECT_GT(point.normal.dot(N), 0.5) << s.transpose();
            }
        }
    }
}

TEST(DistortedFacet, HasExactVariationsPastItsFold) {
    Random random(94);
    std::vector<Vec3> warped = trapezoid();
    warped[1].z() = 0.03;
    for (const Vec3& s : {Vec3(0.52, 1.3, 0.05), Vec3(0.4, 1.8, -0.1)}) {
        const Vec3 ds = random.vector();
        std::vector<Vec3> dx;
        for (int i = 0; i < 4; ++i) dx.push_back(random.vector());
        const auto moved = [&](double t) {
            std::vector<Vec3> x = warped;
            for (std::size_t i = 0; i < 4; ++i) x[i] += t * dx[i];
            return OneFacet(x).at(s + t * ds);
        };
        constexpr double step = 1e-5, tolerance = 1e-6; // of its square times third derivatives, and round-off
        ContactVariation variation;
        const ContactPoint point = OneFacet(warped).at(s, &variation), plus = moved(step), minus = moved(-step);
        ASSERT_TRUE(point.found && plus.found && minus.found);
        Vector dy(15);
        dy << ds, dx[0], dx[1], dx[2], dx[3];
        EXPECT_NEAR(variation.dg.dot(dy), (plus.gap - minus.gap) / (2 * step), tolerance);
        EXPECT_LT((variation.dn * dy - (plus.normal - minus.normal) / (2 * step)).norm(), tolerance);
        EXPECT_LT((variation.dweights * dy - (plus.weights - minus.weights) / (2 * step)).norm(), 10 * tolerance);
    }
}

/// Places within a distorted facet are found there, and not past its edges.
TEST(DistortedFacet, FindsEveryPlaceWithinIt) {
    Random random(95);
    for (const std::vector<Vec3>& x : convex(200)) {
        const OneFacet facet(x);
        MatrixX3 corners(4, 3);
        for (Index b = 0; b < 4; ++b) corners.row(b) = x[static_cast<std::size_t>(b)].transpose();
        for (int i = 0; i < 50; ++i) {
            const Vec2 u(random.uniform(-1, 1), random.uniform(-1, 1));
            const Vec3 s = FacetPatch(4).point(u, corners).X + Vec3(0, 0, 0.1);
            const FacetHit hit = FacetSearch(*facet.topology).closest_on(0, s, x);
            EXPECT_LT((hit.u - u).norm(), 1e-9) << u.transpose();
            EXPECT_NEAR(hit.distance, 0.1, round_off);
        }
    }
}

} // namespace
} // namespace osculate::contact::OSCULATE_THIS_FILE
