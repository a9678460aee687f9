/// General contact at edges and corners: edges on edges, what rolls round a corner, what tips over an edge.

#include "support/diary.hpp"
#include "support/scene_file.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

using support::Diary;

struct Outcome {
    app::Plan plan;
    Diary diary;

    /// What contact does to a body in a state, N: to its nodes, whether they are slaves or masters.
    [[nodiscard]] Vec3 force(const std::string& body, const model::State& state) const {
        const auto& bodies = plan.model.bodies;
        const model::Body& one = *std::ranges::find(bodies, body, &model::Body::name);
        const Field x = sum(plan.model.X, state.u);
        Timings unused;
        Vec3 all = Vec3::Zero();
        for (const model::ContactHistory& history : state.contact) {
            model::ContactEvaluation contact(*history.pair);
            contact.begin_step(x, history, unused, 1);
            contact.evaluate(x, unused, 1);
            for (Index j = 0; j < history.pair->size(); ++j)
                contact.for_each_force(j, history.lambda[static_cast<std::size_t>(j)], [&](Index node, const Vec3& f) {
                    if (node >= one.first_node && node < one.first_node + one.nodes()) all += f;
                });
        }
        return all;
    }
    [[nodiscard]] Vec3 last_force(const std::string& body) const { return force(body, diary.states.back()); }
};

Outcome run(const std::string& text, const std::vector<scene::Override>& changes = {}, int reject_every = 0,
            int threads = 1) {
    Outcome one{support::compiled(scene::read_scene(support::scene_file("edges.yaml", text), changes), threads), {}};
    one.diary = support::diary_of(one.plan, reject_every);
    return one;
}

/// An elastic roller, wider than a block, that a rigid core leads along the top, round a corner of 90 degrees, and back.
const std::string roller = R"yaml(
bodies:
  block:
    mesh: {block: {origin: [-0.2 m, -0.1 m, -0.2 m], size: [0.2 m, 0.2 m, 0.2 m], divisions: [4, 4, 4]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0.3}}
  roller:
    mesh:
      tube: {inner_radius: 0.03 m, thickness: 0.02 m, length: 0.3 m, divisions: [24, 6, 2]}
      rotate: {axis: [1, 0, 0], angle: 90 deg}
      translate: [-0.02 m, 0.15 m, 0.05 m]
    material: {neo_hookean: {E: 10 MPa, nu: 0.3}}
sets:
  bed: {body: block, surface: z_min}
  wall: {body: block, surface: x_min}
  core: {body: roller, surface: inner}
supports:
  bed: {fix: [x, y, z]}
  wall: {fix: [x, y, z]}
contact: {general: {friction: 0, discretisation: node}}
stages:
  down: {displacement: {core: {x: 0 m, y: 0 m, z: -1 mm}}}
  along: {steps: 2, displacement: {core: {x: 0.02 m, y: 0 m, z: -1 mm}}}
  round:
    steps: 10
    displacement:
      core: {x: {expression: "0.02 + 0.049*sin(pi/2*t)", unit: m}, y: 0 m, z: {expression: "-0.05 + 0.049*cos(pi/2*t)", unit: m}}
  back:
    steps: 10
    displacement:
      core: {x: {expression: "0.02 + 0.049*cos(pi/2*t)", unit: m}, y: 0 m, z: {expression: "-0.05 + 0.049*sin(pi/2*t)", unit: m}}
)yaml";

class RollerRoundACorner : public testing::TestWithParam<std::string> {};

TEST_P(RollerRoundACorner, HasForcesThatAreTheSameOutAndBack) {
    constexpr double same = 1e-6;        // of the largest force
    constexpr int steps = 10, first = 3; // states before the corner
    const Outcome found = run(roller, {{"contact.general.discretisation", GetParam()}});
    ASSERT_EQ(found.diary.states.size(), static_cast<std::size_t>(first + 2 * steps));
    const auto force = [&](int k) { return found.force("roller", found.diary.states[static_cast<std::size_t>(k)]); };
    double largest = 0;
    for (int k = 0; k < first + 2 * steps; ++k) largest = std::max(largest, force(k).norm());
    EXPECT_GT(largest, 100);
    for (int k = 1; k < steps; ++k) {
        const Vec3 out = force(first - 1 + k), home = force(first - 1 + 2 * steps - k);
        EXPECT_LT((out - home).norm(), same * largest) << k;
        EXPECT_GT(out.norm(), 0.5 * largest) << k; // it never falls in
        // the corner presses on the axis, at the angle of the roller's way round
        const double angle = 0.5 * std::numbers::pi * k / steps;
        EXPECT_NEAR(std::atan2(out.x(), out.z()), angle, 0.15) << k;
    }
    const Vec3 middle = force(first - 1 + steps / 2);
    EXPECT_LT(std::abs(middle.x() - middle.z()), same * largest); // symmetric about 45 degrees
}

INSTANTIATE_TEST_SUITE_P(EdgeContact, RollerRoundACorner, testing::Values("node", "petrov_galerkin"));

/// Two bars, ridge on ridge: a crossing between nodes, at a node of one, and at nodes of both.
const std::string ridges = R"(
bodies:
  lower:
    mesh: {block: {origin: [-0.5 m, -0.05 m, -0.05 m], size: [1 m, 0.1 m, 0.1 m], divisions: [9, 2, 2]}, rotate: {axis: [1, 0, 0], angle: 45 deg}}
    material: {neo_hookean: {E: 100 MPa, nu: 0.3}}
  upper:
    mesh: {block: {origin: [-0.05 m, -0.5 m, -0.05 m], size: [0.1 m, 1 m, 0.1 m], divisions: [2, 9, 2]}, rotate: {axis: [0, 1, 0], angle: 45 deg}, translate: [0 m, 0 m, 0.1424213562 m]}
    material: {neo_hookean: {E: 100 MPa, nu: 0.3}}
sets:
  ends0: {body: lower, surface: x_min}
  ends1: {body: lower, surface: x_max}
  tips0: {body: upper, surface: y_min}
  tips1: {body: upper, surface: y_max}
supports:
  ends0: {fix: [x, y, z]}
  ends1: {fix: [x, y, z]}
contact: {general: {friction: 0.3}}
stages:
  press: {steps: 4, displacement: {tips0: {x: 0 m, y: 0 m, z: -8 mm}, tips1: {x: 0 m, y: 0 m, z: -8 mm}}}
)";

TEST(EdgeContact, OfRidgesPressesAlongTheirCommonNormalWhereverTheNodesAre) {
    constexpr double symmetric = 1e-6, mesh = 0.1; // of the force; what the four meshes differ by
    double like = 0;
    for (const auto& [below, above] : {std::pair{9, 9}, std::pair{8, 9}, std::pair{9, 8}, std::pair{8, 8}}) {
        const Outcome found =
            run(ridges, {{"bodies.lower.mesh.block.divisions", "[" + std::to_string(below) + ", 2, 2]"},
                         {"bodies.upper.mesh.block.divisions", "[2, " + std::to_string(above) + ", 2]"}});
        const Vec3 force = found.last_force("upper");
        EXPECT_LT((force + found.last_force("lower")).norm(), 1e-9 * force.norm());
        EXPECT_LT(std::hypot(force.x(), force.y()), symmetric * force.z()) << below << ' ' << above;
        if (like == 0) like = force.z();
        EXPECT_NEAR(force.z(), like, mesh * like) << below << ' ' << above;
    }
}

TEST(EdgeContact, DoesNotDependOnWhichBodyComesFirstNorOnThePlace) {
    // off the middle, so that the ends of the edges share the force unevenly
    const std::string aside = "0.013 m, 0.021 m, 0.1424213562 m";
    const auto moved = [&](std::string text, const std::string& to) {
        text.replace(text.find("0 m, 0 m, 0.1424213562 m"), std::string("0 m, 0 m, 0.1424213562 m").size(), to);
        return text;
    };
    const std::string first = moved(ridges, aside);
    const std::size_t upper = first.find("  upper:"), lower = first.find("  lower:"), sets = first.find("sets:");
    const std::string swapped = first.substr(0, lower) + first.substr(upper, sets - upper) +
                                first.substr(lower, upper - lower) + first.substr(sets);
    const Vec3 force = run(first).last_force("upper"), other = run(swapped).last_force("upper");
    EXPECT_LT((force - other).norm(),
              1e-3 * force.norm()); // contacts that may share a place yield by 0.01 of a node's own
    // both a metre away
    std::string far = moved(ridges, "1.013 m, -0.979 m, 1.1424213562 m");
    const std::string angle = "axis: [1, 0, 0], angle: 45 deg}";
    far.replace(far.find(angle), angle.size(), angle + ", translate: [1 m, -1 m, 1 m]");
    EXPECT_LT((run(far).last_force("upper") - force).norm(), 1e-8 * force.norm());
}

TEST(EdgeContact, LeavesNoTraceOfRejectedAttemptsAndNoneOfThreads) {
    const Diary one = run(ridges).diary, rejecting = run(ridges, {}, 2).diary, threads = run(ridges, {}, 0, 3).diary;
    ASSERT_EQ(one.states.size(), rejecting.states.size());
    for (std::size_t k = 0; k < one.states.size(); ++k) {
        EXPECT_EQ(largest_distance(one.states[k].u, rejecting.states[k].u).value, 0);
        EXPECT_EQ(largest_distance(one.states[k].u, threads.states[k].u).value, 0);
    }
}

/// A brick that lies on a table with its centre of mass beyond the edge.
const std::string brick = R"(
bodies:
  table:
    mesh: {block: {origin: [-1 m, -0.5 m, -0.3 m], size: [1 m, 1 m, 0.3 m], divisions: [4, 4, 2]}}
    material: {neo_hookean: {E: 100 MPa, nu: 0.3, density: 1000 kg/m^3}}
  brick:
    mesh: {block: {origin: [-0.2 m, -0.11 m, 0 m], size: [0.6 m, 0.2 m, 0.1 m], divisions: [7, 3, 3]}}
    material: {neo_hookean: {E: 100 MPa, nu: 0.3, density: 1000 kg/m^3}}
sets:
  bed: {body: table, surface: z_min}
supports:
  bed: {fix: [x, y, z]}
gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
contact: {general: {friction: 0.5}}
stages:
  fall: {analysis: dynamic, duration: 0.1 s, steps: 50}
)";

TEST(EdgeContact, LetsABrickTipAboutTheEdgeOfATable) {
    // a rigid brick about the edge: (I + m r^2) theta'' = m g (d cos theta + h sin theta)
    constexpr double g = 9.81, length = 0.6, height = 0.1, d = 0.1, h = 0.05, end = 0.1, dt = 1e-5;
    double theta = 0, rate = 0;
    for (int k = 0; k < static_cast<int>(end / dt); ++k) {
        rate += dt * g * (d * std::cos(theta) + h * std::sin(theta)) /
                ((length * length + height * height) / 12 + d * d + h * h);
        theta += dt * rate;
    }
    const Outcome found = run(brick);
    const model::Body& body = found.plan.model.bodies[1];
    // the turn that fits its nodes best, in the plane of x and z
    Vec3 X0 = Vec3::Zero(), x0 = Vec3::Zero();
    const Field& u = found.diary.states.back().u;
    for (Index i = 0; i < body.nodes(); ++i) {
        X0 += body.mesh.nodes[i] / body.nodes();
        x0 += (body.mesh.nodes[i] + u[body.first_node + i]) / body.nodes();
    }
    double along = 0, across = 0;
    for (Index i = 0; i < body.nodes(); ++i) {
        const Vec3 a = body.mesh.nodes[i] - X0, b = body.mesh.nodes[i] + u[body.first_node + i] - x0;
        along += a.x() * b.x() + a.z() * b.z();
        across += a.z() * b.x() - a.x() * b.z();
    }
    EXPECT_NEAR(std::atan2(across, along), theta, 0.03 * theta); // it first sinks in by what the table gives way
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
