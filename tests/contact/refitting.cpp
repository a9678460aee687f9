#include "blend_surfaces.hpp"
#include "osculate/contact/search.hpp"

#include <Eigen/Geometry>

namespace osculate::contact::OSCULATE_THIS_FILE {
namespace {

using namespace fixtures;

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

struct Refitting : ::testing::Test {
    Surface flat = plate(0).surface("plate");
    std::shared_ptr<const MasterSurface> master = make_blend_surface(flat.topology, flat.x, {});

    /// Goes on with the surface fitted anew at x. @returns how many patches were
    Index refit(const std::vector<Vec3>& x) {
        auto next = master->refitted(x);
        if (next == nullptr) return 0;
        const Index fresh = next->refits_done() - master->refits_done();
        master = std::move(next);
        return fresh;
    }
    static std::vector<Vec3> at(double turn) { return plate(turn).surface("bent").x; }
    static double degrees(double angle) { return angle * pi / 180; }
};

TEST_F(Refitting, LeavesPatchesAloneThatAreMovedTurnedOrBentALittle) {
    std::vector<Vec3> x = flat.x;
    const Mat3 Q = Eigen::AngleAxisd(2.8, Vec3(1, 2, 3).normalized()).toRotationMatrix();
    for (Vec3& v : x) v = Q * v + Vec3(5, -7, 11);
    EXPECT_EQ(refit(x), 0);
    EXPECT_EQ(refit(at(degrees(25))), 0); // 37 degrees from a vertex to the farthest facet of its patch
}

TEST_F(Refitting, FitsPatchesAnewThatAreBentMoreThanSixtyDegrees) {
    const std::vector<Vec3> x = at(degrees(44)); // 66 degrees to the farthest facet
    const Index fresh = refit(x);
    EXPECT_GE(fresh, (columns - 3) * (rows + 1)); // all but those at the ends, which see fewer facets
    EXPECT_EQ(refit(x), 0) << "done already";
    EXPECT_GT(refit(flat.x), 0) << "and back";
}

/// A surface made anew and told what was refitted is, to the last bit, the one that went through it.
TEST_F(Refitting, CanBeDoneAgainFromWhatItWasDoneWith) {
    const std::vector<Vec3> first = at(degrees(44)), x = at(degrees(-3));
    EXPECT_GT(refit(first), 0);
    EXPECT_GT(refit(x), 0);
    const std::vector<RefittedPatch> done = master->refitted_patches();
    const auto again = make_blend_surface(flat.topology, flat.x, {})->refitted(done);
    ASSERT_TRUE(again);
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
    EXPECT_FALSE(untouched->refitted(std::vector<RefittedPatch>{{1 << 20, {}}}));
    EXPECT_FALSE(untouched->refitted(std::vector<RefittedPatch>{{0, {Vec3::Zero()}}}));
}

/// Whoever holds the surface of an earlier step keeps what it had.
TEST_F(Refitting, LeavesTheSurfaceItIsAskedOfAlone) {
    const auto made = master;
    const std::vector<Vec3> x = at(degrees(44));
    ASSERT_GT(refit(x), 0);
    EXPECT_EQ(made->refits_done(), 0);
    EXPECT_TRUE(made->refitted_patches().empty());
    EXPECT_GT(static_cast<Index>(master->refitted_patches().size()), 0);
    const auto untouched = make_blend_surface(flat.topology, flat.x, {});
    FacetSearch search(flat.topology, x, Vec3(0, 0, 100));
    search.build(x);
    const Vec3 s = bent(0.52, 0.47, degrees(44)) * 1.01;
    const FacetHit hit = search.global(s, x);
    ContactPoint before, after, expected;
    made->evaluate(s, hit, x, before);
    master->evaluate(s, hit, x, after);
    untouched->evaluate(s, hit, x, expected);
    EXPECT_EQ(before.gap, expected.gap); // to the bit
    EXPECT_NE(after.gap, before.gap);
}

/// Two nodes of the plate all but coincide and count as one: the numbers of its patches are not those of its vertices.
TEST(RefittingOverMergedNodes, KeepsTheSurfaceThroughItsNodes) {
    constexpr double apart = 1e-5;
    const auto doubled = [](double turn) {
        Shell s = plate(turn);
        const Index v = columns / 2 + (columns + 1) * (rows / 2), twin = v + 1; // moves in behind its neighbour
        for (auto& facet : s.facets)
            for (Index& node : facet)
                if (node > v) ++node;
        s.x.insert(s.x.begin() + twin, bent(0.5 + apart / columns, 0.5, turn));
        for (auto& facet : s.facets)
            for (Index& node : facet)
                if (node == v && std::ranges::find(facet, v + 2) != facet.end()) node = twin;
        s.facets.push_back({v, twin, v + 2 + columns});
        s.facets.push_back({twin, v, v - 1 - columns});
        return s;
    };
    const Surface flat = doubled(0).surface("plate");
    const auto made = make_blend_surface(flat.topology, flat.x, {});
    ASSERT_GT(made->fallbacks(), 0) << "nothing is merged";
    const std::vector<Vec3> x = doubled(44 * pi / 180).surface("bent", 89).x;
    const auto master = made->refitted(x);
    ASSERT_TRUE(master);
    FacetSearch search(flat.topology, x, Vec3(0, 0, 100));
    search.build(x);
    for (Index v = 0; v < flat.topology.vertex_count(); ++v) {
        ContactPoint point;
        master->evaluate(x[v], search.global(x[v], x), x, point);
        ASSERT_TRUE(point.found) << v;
        EXPECT_LT(std::abs(point.gap), 2 * apart) << v;
    }
}

/// At 62 degrees a facet two rings no longer lie flat: patches get smaller, and so does what facets say they need.
TEST_F(Refitting, NamesTheVerticesThatPatchesHoldNow) {
    const std::vector<Vec3> x = at(degrees(62));
    const Surface there = plate(degrees(62)).surface("bent", 89);
    const auto fresh = make_blend_surface(there.topology, there.x, {});
    const Index inner = columns / 2 + columns * (rows / 2); // all patches near it are bent
    const auto named = [&](const MasterSurface& surface, Index facet) {
        const auto vertices = surface.patch_vertices(facet);
        return std::vector<Index>(vertices.begin(), vertices.end());
    };
    const auto before = named(*master, inner);
    ASSERT_GT(refit(x), 0);
    EXPECT_EQ(named(*master, inner), named(*fresh, inner));
    EXPECT_NE(named(*master, inner), before);
    const auto again = make_blend_surface(flat.topology, flat.x, {})->refitted(master->refitted_patches());
    ASSERT_TRUE(again);
    for (Index f = 0; f < flat.topology.facet_count(); ++f) EXPECT_EQ(named(*again, f), named(*master, f));
}

/// What is made ready at some positions does not serve at others, by a rigid motion either.
TEST_F(Refitting, EvaluatesAtThePositionsGivenWhateverWasPlaced) {
    FacetSearch search(flat.topology, flat.x, Vec3(0, 0, 100));
    search.build(flat.x);
    const Vec3 s = bent(0.52, 0.47, 0) + Vec3(0, 0, 0.1);
    const FacetHit hit = search.global(s, flat.x);
    std::unique_ptr<Placement> placement;
    master->place(std::span(&hit, 1), flat.x, 1, placement);
    ASSERT_TRUE(placement);
    const Index near = flat.topology.facet_vertices(hit.facet)[0];
    std::vector<Vec3> one = flat.x, all = flat.x;
    one[near] += Vec3(0, 0, 0.02);
    for (Vec3& v : all) v += Vec3(0, 0, 0.03);
    for (const std::vector<Vec3>& x : {one, all, flat.x}) {
        ContactPoint placed, expected;
        ContactVariation placed_variation, variation;
        master->evaluate(s, hit, x, placed, &placed_variation, placement.get());
        master->evaluate(s, hit, x, expected, &variation);
        ASSERT_TRUE(placed.found && expected.found);
        EXPECT_EQ(placed.gap, expected.gap); // to the bit
        EXPECT_EQ(placed.normal, expected.normal);
        EXPECT_EQ(placed.pressing, expected.pressing);
        EXPECT_EQ(placed_variation.dn, variation.dn);
    }
}

TEST_F(Refitting, KeepsTheSurfaceThroughItsNodes) {
    const std::vector<Vec3> x = at(degrees(44));
    refit(x);
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

TEST_F(Refitting, GivesTheSurfaceThatWouldHaveBeenMadeThere) {
    const std::vector<Vec3> x = at(degrees(44));
    Surface there = plate(degrees(44)).surface("bent", 89);
    const auto fresh = make_blend_surface(there.topology, there.x, {});
    ASSERT_GT(refit(x), 0);
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
} // namespace osculate::contact::OSCULATE_THIS_FILE
