/// What paths of slave nodes through moving facets say against a step, in numbers.

#include "osculate/time/collision_check.hpp"

#include "osculate/app/compile.hpp"
#include "osculate/scene/reader.hpp"

#include <gtest/gtest.h>

namespace osculate::time {
namespace {

/// A small cube above a plate whose upper face is at z = 0, in facets of 0.5 m.
const char* const plate_and_cube = R"(
bodies:
  plate:
    mesh: {block: {origin: [-2 m, -1 m, -0.2 m], size: [4 m, 2 m, 0.2 m], divisions: [8, 4, 1]}}
    material: {linear_elastic: {E: 1 MPa, nu: 0.3, density: 1000 kg/m^3}}
  cube:
    mesh: {block: {origin: [0 m, 0.1 m, 0 m], size: [0.1 m, 0.1 m, 0.1 m], divisions: [1, 1, 1]}}
    material: {linear_elastic: {E: 1 MPa, nu: 0.3, density: 1000 kg/m^3}}
sets:
  bed: {body: plate, surface: z_min}
  ground: {body: plate, surface: z_max}
  sole: {body: cube, surface: z_min}
supports: {bed: {fix: [x, y, z]}}
contact:
  joint: {slave: sole, master: {set: ground, surface: facets}}
stages:
  fly: {analysis: dynamic}
)";
constexpr double facet = 0.5, edge = 0.1;  // m
constexpr double round_off = 1e-12;        // of fractions of the step: bisection down to neighbouring numbers
constexpr double same_place = 1e-9 * edge; // m: of the shares of corners within which an edge belongs to both sides

class Paths : public ::testing::Test {
protected:
    Paths() {
        const scene::Scene scene = scene::parse_scene(plate_and_cube, "plate_and_cube.yaml");
        plan = app::compile(scene, app::build_meshes(scene), 1, timings);
        limits.allowed_interpenetration = 0.01; // of a facet
        start.u.assign(plan.model.X.size(), Vec3::Zero());
        for (const auto& pair : plan.model.pairs) start.contact.push_back(pair->initial_history());
        contact = model::contact_evaluations(plan.model);
    }
    /// Moves the cube by d.
    void move_cube(std::vector<Vec3>& u, const Vec3& d) const {
        for (std::size_t i = plan.model.bodies[1].first_node; i < u.size(); ++i) u[i] += d;
    }
    /// What there is to say of a trial that ends at displacements u.
    [[nodiscard]] StepEvidence trial(const std::vector<Vec3>& u) {
        CollisionCheck check(plan.model, contact, limits, true, timings, 1);
        check.begin_step(start);
        std::vector<Vec3> x = plan.model.X;
        for (std::size_t i = 0; i < x.size(); ++i) x[i] += u[i];
        contact[0].evaluate(x, timings, 1);
        StepEvidence evidence;
        check.add_trial(u, evidence);
        return evidence;
    }
    [[nodiscard]] Vec3 place(Index slave) const {
        const Index node = plan.model.pairs[0]->slaves().node[slave];
        return plan.model.X[node] + start.u[node];
    }

    Timings timings;
    app::Plan plan;
    StepLimits limits;
    model::State start;
    model::ContactEvaluations contact;
};

/// The plate turns upright about its middle, as far as straight paths do: its points s go to (s(1-t), s t). The cube
/// stands still, at (x, d): it is met at t = d/(x+d), first by its outermost nodes.
TEST_F(Paths, OfAMasterThatTurnsBelowASlaveAtRestAreFollowed) {
    const double d = 0.25, x = 1.2;
    for (const int side : {1, -1}) {
        start.u.assign(start.u.size(), Vec3::Zero());
        move_cube(start.u, {side > 0 ? x - edge : -x, 0, d});
        std::vector<Vec3> u = start.u;
        for (Index i = 0; i < plan.model.bodies[0].nodes(); ++i) {
            const Vec3& X = plan.model.X[i];
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
        start.u.assign(start.u.size(), Vec3::Zero());
        move_cube(start.u, {-1.4, 0, height});
        std::vector<Vec3> u = start.u;
        move_cube(u, {1.6, 0, -fall});
        const double expected = height > g_p ? height / fall : limits.reserve * (g_p + height) / fall;
        EXPECT_NEAR(trial(u).collision, expected, round_off) << height;
    }
}

/// Nothing is said of nodes that are too far from the plate for their motion, however the two move together.
TEST_F(Paths, AreNotFollowedWhereTheMotionCannotReach) {
    move_cube(start.u, {0, 0, 0.6});
    std::vector<Vec3> u = start.u;
    const Vec3 together(3, 2, -5);
    for (Vec3& v : u) v += together;
    move_cube(u, {0, 0, -0.55});
    CollisionCheck check(plan.model, contact, limits, true, timings, 1);
    check.begin_step(start);
    std::vector<Vec3> x = plan.model.X;
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
    std::vector<Vec3> u = start.u;
    move_cube(u, {1.6, 0, -0.3});
    const StepEvidence evidence = trial(u);
    EXPECT_EQ(evidence.collision, 1);
    EXPECT_TRUE(evidence.gaps.empty());
}

/// A closed node that loses the surface speaks by its motion along the normal relative to the master, which is none here.
TEST_F(Paths, OfClosedNodesThatLeaveAFlyingPlateAreTakenRelativeToIt) {
    move_cube(start.u, {1.9 - edge, 0, 1e-3});
    start.contact[0].status.assign(start.contact[0].status.size(), contact::Status::glide);
    std::vector<Vec3> u = start.u;
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
        start.u.assign(start.u.size(), Vec3::Zero());
        move_cube(start.u, {0.1, 0, overlap ? -1.5 * g_p : -0.5 * g_p});
        std::vector<Vec3> u = start.u;
        move_cube(u, {0, 0, -2 * g_p});
        EXPECT_EQ(trial(u).gaps.empty(), overlap);
    }
}

} // namespace
} // namespace osculate::time
