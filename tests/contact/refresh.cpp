#include "blend_surfaces.hpp"
#include "osculate/contact/search.hpp"

#include <Eigen/Geometry>

namespace osculate::contact {
namespace {

using namespace testing;

constexpr int columns = 12, rows = 6;

/// A plate of unit squares, bent along its first direction by `turn` radians a facet.
Vec3 bent(double s, double t, double turn) {
    const double x = s * columns, y = t * rows;
    if (turn == 0) return {x, y, 0};
    return {std::sin(x * turn) / turn, y, (std::cos(x * turn) - 1) / turn};
}
Shell plate(double turn) {
    return grid(columns, rows, false, false, [=](double s, double t) { return bent(s, t, turn); });
}

struct Refresh : ::testing::Test {
    Surface flat = plate(0).surface("plate");
    std::unique_ptr<MasterSurface> master = make_blend_surface(flat.topology, flat.x, {});

    static std::vector<Vec3> at(double turn) { return plate(turn).surface("bent").x; }
    static double degrees(double angle) { return angle * pi / 180; }
};

TEST_F(Refresh, LeavesPatchesAloneThatAreMovedTurnedOrBentALittle) {
    std::vector<Vec3> x = flat.x;
    const Mat3 Q = Eigen::AngleAxisd(2.8, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    for (Vec3& v : x) v = Q * v + Vec3(5, -7, 11);
    EXPECT_EQ(master->refresh(x), 0);
    EXPECT_EQ(master->refresh(at(degrees(25))), 0); // 37 degrees from a vertex to the farthest facet of its patch
}

TEST_F(Refresh, FitsPatchesAnewThatAreBentMoreThanSixtyDegrees) {
    const std::vector<Vec3> x = at(degrees(44)); // 66 degrees to the farthest facet
    const Index fresh = master->refresh(x);
    EXPECT_GE(fresh, (columns - 3) * (rows + 1)); // all but those at the ends, which see fewer facets
    EXPECT_EQ(master->refresh(x), 0) << "done already";
    EXPECT_GT(master->refresh(flat.x), 0) << "and back";
}

/// A surface made anew and told what was refitted is, to the last bit, the one that went through it.
TEST_F(Refresh, CanBeDoneAgainFromWhatItWasDoneWith) {
    const std::vector<Vec3> first = at(degrees(44)), x = at(degrees(-3));
    EXPECT_GT(master->refresh(first), 0);
    EXPECT_GT(master->refresh(x), 0);
    const std::vector<RefittedPatch> done = master->refitted();
    const auto again = make_blend_surface(flat.topology, flat.x, {});
    ASSERT_TRUE(again->refit(done));
    FacetSearch search(flat.topology, x, Vec3(0, 0, 100));
    search.build(x);
    const auto untouched = make_blend_surface(flat.topology, flat.x, {});
    int different = 0;
    for (int k = 0; k < 50; ++k) {
        const Vec3 s = bent(0.13 + 0.015 * k, 0.21 + 0.011 * k, degrees(-3)) + Vec3(0, 0, 0.05);
        const FacetHit hit = search.global(s, x);
        ContactPoint a, b, c;
        master->evaluate(s, hit, x, a);
        again->evaluate(s, hit, x, b);
        untouched->evaluate(s, hit, x, c);
        ASSERT_EQ(a.gap, b.gap);
        ASSERT_EQ(a.normal, b.normal);
        different += a.gap != c.gap;
    }
    EXPECT_GT(different, 0) << "refitting changes nothing here";
    EXPECT_FALSE(again->refit({{1 << 20, {}}}));
    EXPECT_FALSE(again->refit({{0, {Vec3::Zero()}}}));
}

TEST_F(Refresh, KeepsTheSurfaceThroughItsNodes) {
    const std::vector<Vec3> x = at(degrees(44));
    master->refresh(x);
    FacetSearch search(flat.topology, x, Vec3(0, 0, 100));
    search.build(x);
    for (Index v = 0; v < flat.topology.vertex_count(); ++v) {
        ContactPoint point;
        master->evaluate(x[v], search.global(x[v], x), x, point);
        ASSERT_TRUE(point.found);
        const double round_off = 1e-11; // of the facets' size, one
        EXPECT_LT(std::abs(point.gap), round_off);
    }
}

TEST_F(Refresh, GivesTheSurfaceThatWouldHaveBeenMadeThere) {
    const std::vector<Vec3> x = at(degrees(44));
    Surface there = plate(degrees(44)).surface("bent", 89);
    const auto fresh = make_blend_surface(there.topology, there.x, {});
    ASSERT_GT(master->refresh(x), 0);
    FacetSearch search(flat.topology, x, Vec3(0, 0, 100));
    search.build(x);
    const Vec3 s = bent(0.52, 0.47, degrees(44)) * 1.01;
    const FacetHit hit = search.global(s, x);
    ContactPoint a, b;
    master->evaluate(s, hit, x, a);
    fresh->evaluate(s, hit, x, b);
    ASSERT_TRUE(a.found && b.found);
    EXPECT_EQ(a.gap, b.gap); // to the bit
    EXPECT_EQ(a.normal, b.normal);
}

} // namespace
} // namespace osculate::contact
