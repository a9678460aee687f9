/// What paths of slave nodes through moving facets say against a step, in numbers.

#include "osculate/time/collision_check.hpp"

#include "support/small_model.hpp"

#include <gtest/gtest.h>

namespace osculate::time::OSCULATE_THIS_FILE {
namespace {

constexpr double facet = 0.5, edge = 0.1;  // m
constexpr double round_off = 1e-12;        // of fractions of the step: bisection down to neighbouring numbers
constexpr double same_place = 1e-9 * edge; // m: of the shares of corners within which an edge belongs to both sides

/// A small cube above a plate whose upper face is at z = 0, in facets of 0.5 m.
class Paths : public ::testing::Test {
protected:
    Paths() {
        const material::LinearElastic elastic{1e6, 0.3};
        constexpr double thickness = 0.2;
        small.add_body("plate", mesh::make_block({-2, -1, -thickness}, {4, 2, thickness}, {8, 4, 1}), elastic);
        small.add_body("cube", mesh::make_block({0, 0.1, 0}, {edge, edge, edge}, {1, 1, 1}), elastic);
        small.add_pair("joint", {1, "z_min"}, {0, "z_max"}, elastic.E, 0, thickness);
        limits.allowed_interpenetration = 0.01; // of a facet
        start = small.at_rest();
        contact = model::contact_evaluations(model.pairs);
    }
    /// Moves the cube by d.
    void move_cube(Field& u, const Vec3& d) const {
        for (std::size_t i = model.bodies[1].first_node; i < u.size(); ++i) u[i] += d;
    }
    /// What there is to say of a trial that ends at displacements u.
    [[nodiscard]] StepEvidence trial(const Field& u) {
        CollisionCheck check(model, contact, limits, true, timings, 1);
        check.begin_step(start);
        contact[0].evaluate(sum(model.X, u), timings, 1);
        StepEvidence evidence;
        check.add_trial(u, evidence);
        return evidence;
    }
    [[nodiscard]] Vec3 place(Index slave) const {
        const Index node = model.pairs[0]->slaves().node[slave];
        return model.X[node] + start.u[node];
    }

    Timings timings;
    support::SmallModel small;
    const model::Model& model = small.model;
    StepLimits limits;
    model::State start;
    model::ContactEvaluations contact;
};

/// The plate turns upright about its middle, as far as straight paths do: its points s go to (s(1-t), s t). The cube
/// stands still, at (x, d): it is met at t = d/(x+d), first by its outermost nodes.
TEST_F(Paths, OfAMasterThatTurnsBelowASlaveAtRestAreFollowed) {
    const double d = 0.25, x = 1.2;
    for (const int side : {1, -1}) {
        start.u.reset(start.u.size());
        move_cube(start.u, {side > 0 ? x - edge : -x, 0, d});
        Field u = start.u;
        for (Index i = 0; i < model.bodies[0].nodes(); ++i) {
            const Vec3& X = model.X[i];
            u[i] = Vec3(-side * X.z() - X.x(), 0, side * X.x() - X.z());
        }
        const StepEvidence evidence = trial(u);
        EXPECT_NEAR(evidence.collision, d / (x + d), round_off) << side;
        ASSERT_EQ(evidence.collision_pair, 0);
        EXPECT_NEAR(std::abs(place(evidence.collision_slave).x()), x, same_place) << side;
    }
}

/// (27) from afar, (28) from near the surface. The path leads on over three facets, so that the gap where it ends says
/// nothing of it.
TEST_F(Paths, EndOnTheSurfaceFromAfarAndAsDeepAsIsAllowedFromNear) {
    const double g_p = limits.allowed_interpenetration * facet, fall = 0.3;
    for (const double height : {20 * g_p, 0.4 * g_p}) {
        start.u.reset(start.u.size());
        move_cube(start.u, {-1.4, 0, height});
        Field u = start.u;
        move_cube(u, {1.6, 0, -fall});
        const double expected = height > g_p ? height / fall : limits.reserve * (g_p + height) / fall;
        EXPECT_NEAR(trial(u).collision, expected, round_off) << height;
    }
}

/// Nothing is said of nodes that are too far from the plate for their motion, however the two move together.
TEST_F(Paths, AreNotFollowedWhereTheMotionCannotReach) {
    move_cube(start.u, {0, 0, 0.6});
    Field u = start.u;
    const Vec3 together(3, 2, -5);
    for (Vec3& v : u) v += together;
    move_cube(u, {0, 0, -0.55});
    CollisionCheck check(model, contact, limits, true, timings, 1);
    check.begin_step(start);
    std::vector<Vec3> x = model.X;
    for (std::size_t i = 0; i < x.size(); ++i) x[i] += u[i];
    contact[0].evaluate(x, timings, 1);
    StepEvidence evidence;
    check.add_trial(u, evidence);
    EXPECT_EQ(check.take_paths_followed(), 0);
    EXPECT_EQ(evidence.collision, 1);
}

/// Closed nodes follow the surface: no path of theirs, and no gap, speaks against a step.
TEST_F(Paths, OfClosedNodesAreNone) {
    move_cube(start.u, {-1.4, 0, 1e-3}); // on the surface itself no path would begin by crossing it
    start.contact[0].status.assign(start.contact[0].status.size(), contact::Status::glide);
    Field u = start.u;
    move_cube(u, {1.6, 0, -0.3});
    const StepEvidence evidence = trial(u);
    EXPECT_EQ(evidence.collision, 1);
    EXPECT_TRUE(evidence.gaps.empty());
}

/// A closed node that loses the surface speaks by its motion along the normal relative to the master, which is none here.
TEST_F(Paths, OfClosedNodesThatLeaveAFlyingPlateAreTakenRelativeToIt) {
    move_cube(start.u, {1.9 - edge, 0, 1e-3});
    start.contact[0].status.assign(start.contact[0].status.size(), contact::Status::glide);
    Field u = start.u;
    for (Vec3& v : u) v += Vec3(0, 0, -5);
    move_cube(u, {0.8, 0, 0}); // past the edge at x = 2
    const StepEvidence evidence = trial(u);
    EXPECT_EQ(evidence.gaps.size(), start.contact[0].status.size());
    for (const GapEvidence& gap : evidence.gaps) EXPECT_NEAR(gap.g1, gap.g0, round_off);
}

/// An overlap deeper than allowed at the start of a step is for the solution with contact to lift: no step is too short.
TEST_F(Paths, AndGapsOfAnInitialOverlapCutNothing) {
    const double g_p = limits.allowed_interpenetration * facet;
    for (const bool overlap : {true, false}) {
        start.u.reset(start.u.size());
        move_cube(start.u, {0.1, 0, overlap ? -1.5 * g_p : -0.5 * g_p});
        Field u = start.u;
        move_cube(u, {0, 0, -2 * g_p});
        EXPECT_EQ(trial(u).gaps.empty(), overlap);
    }
}

} // namespace
} // namespace osculate::time::OSCULATE_THIS_FILE
