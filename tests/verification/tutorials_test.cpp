/// What the tutorials promise, on their first part where they are long. The bouncing ball is in impact_test.

#include "support/scene_runner.hpp"

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

/// Velocity of a body's centre of mass along x.
double velocity(const support::SceneRun& run, const char* name) {
    const model::Model& model = run.plan.model;
    const Field &v = run.steps.back().state.v, ones(v.size(), Vec3::UnitX());
    Field p(v.size()), m(v.size());
    model.consistent_mass.multiply_add(v, p, 1);
    model.consistent_mass.multiply_add(ones, m, 1);
    double momentum = 0, mass = 0;
    for (const model::Body& body : model.bodies)
        for (Index i = body.first_node; body.name == name && i < body.first_node + body.nodes(); ++i) {
            momentum += p[i].x();
            mass += m[i].x();
        }
    return momentum / mass;
}

TEST(Tutorials, BlockSlidesDownTheSlopeOrStays) {
    const double g = 10 / std::sqrt(1.25), down = 0.5 * g; // components of 10 m/s^2 on 1 : 2
    support::SceneRun slides, stays;
    support::run_scene(slides, support::shipped("tutorials/block_on_incline.yaml"));
    support::run_scene(stays, support::shipped("tutorials/block_on_incline.yaml"), {{"contact.sole.friction", "0.6"}});
    // it lets go once the hold, taken away within 0.05 s, is less than what friction leaves over
    const double start = 0.05 * 0.3 / 0.5, net = down - 0.3 * g;
    const double expected = net * (1 - 0.05) + 0.5 * net * (0.05 - start);
    EXPECT_NEAR(velocity(slides, "block"), expected, 0.01 * expected);
    EXPECT_LT(std::abs(velocity(stays, "block")), 1e-3);
}

TEST(Tutorials, BarsExchangeTheirVelocities) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("tutorials/two_bars.yaml"));
    // what remains is drawn out with the fronts of the waves, some elements of the sixty
    EXPECT_NEAR(velocity(run, "left"), 0, 0.03 * 10);
    EXPECT_NEAR(velocity(run, "right"), 10, 0.03 * 10);
}

TEST(Tutorials, RingIsBrakedByFrictionAlone) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("tutorials/ring_on_cylinder.yaml"),
                       {{"stages.spin.duration", "80 ms"}, {"stages.spin.steps", "40"}});
    const time::Ledger &first = run.steps.front().ledger, &last = run.steps.back().ledger;
    EXPECT_GT(last.friction, 0.3 * first.kinetic);
    EXPECT_LT(last.kinetic, 0.7 * first.kinetic);
    EXPECT_LT(std::abs(last.balance), 1e-6 * first.kinetic);
    EXPECT_LT(last.kinetic + last.strain + last.friction - last.external, 1.02 * first.kinetic);
}

TEST(Tutorials, PressedBlockStandsOnItsPressure) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("tutorials/press_block.yaml"));
    EXPECT_NEAR(run.steps.back().pairs[0].on_slave.z(), 1e5, 1) << "100 kPa on a square metre";
}

TEST(Tutorials, PulledBlockRubs) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("tutorials/pull_block.yaml"));
    const Vec3 force = run.steps.back().pairs[0].on_slave;
    EXPECT_NEAR(force.z(), 1e5, 1);
    // the block spreads sideways under its pressure as it slides: friction of a node that goes astray by an angle a falls
    // short of mu N along the pull by 1 - cos a, and by 1e-3 at 2.5 degrees
    EXPECT_LT(-force.x(), 0.3 * force.z() * (1 + 1e-9)) << "mu = 0.3, against the pull";
    EXPECT_GT(-force.x(), 0.3 * force.z() * (1 - 1e-3));
}

TEST(Tutorials, PadOfAFileLeavesAPrint) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("tutorials/pad_from_file.yaml"));
    const auto force = [&](std::size_t step) { return run.steps[step].pairs[0].on_slave.z(); };
    EXPECT_GT(force(0), 0);
    EXPECT_GT(force(3), 4 * force(0)) << "the contact grows with the depth";
}

/// The bracket is the same on both sides of its pin, its free mesh is not.
TEST(Tutorials, BracketHangsOnBothScrewsAlike) {
    if (!OSCULATE_HAS_GMSH) GTEST_SKIP() << "built without Gmsh's library";
    support::SceneRun run;
    support::run_scene(run, support::shipped("tutorials/bracket.yaml"));
    const double pull = run.steps.back().pairs[0].on_slave.z();
    EXPECT_GT(pull, 1e4);
    const auto on = [&](const std::string& name) {
        double sum = 0;
        for (std::size_t i = 0; i < run.plan.constrained_sets.size(); ++i)
            if (run.plan.model.sets[static_cast<std::size_t>(run.plan.constrained_sets[i])].name == name)
                sum = run.steps.back().reactions[i].z();
        return sum;
    };
    EXPECT_NEAR(on("screw_1") + on("screw_2"), -pull, 1e-8 * pull);
    EXPECT_NEAR(on("screw_1"), on("screw_2"), 0.03 * pull / 2) << "elements of 4 mm along holes of 7";
}

TEST(Tutorials, StackStandsStillUnderItsWeights) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("tutorials/stack.yaml"));
    const model::State& end = run.steps.back().state;
    std::vector<double> carried;
    for (const model::ContactHistory& pair : end.contact) {
        double sum = 0;
        for (const Vec3& lambda : pair.lambda) sum += std::abs(lambda.z());
        if (sum > 0) carried.push_back(sum);
    }
    std::ranges::sort(carried);
    ASSERT_EQ(carried.size(), 10u);
    const double weight = 7850 * std::pow(50e-3, 3) * 9.81;
    for (std::size_t k = 0; k < carried.size(); ++k)
        EXPECT_NEAR(carried[k], static_cast<double>(k + 1) * weight, 1e-4 * weight) << k;
    for (const Vec3& v : end.v.values()) EXPECT_LT(v.norm(), 1e-6);
}

TEST(Tutorials, ToolIntoRubberHasHertzForceAndTheMomentOfFullSliding) {
    support::SceneRun run;
    support::run_scene(run, support::shipped("tutorials/tool_into_rubber.yaml"));
    constexpr double E = 2e6, nu = 0.45, R = 0.06, d = 0.015, h = 0.08, mu = 0.4;
    constexpr double mesh = 0.1; // of 14 elements over the pad, and of strains of a half
    const double a = std::sqrt(R * d), chi = a / h;
    // Hertz on a thin layer that is bonded below, nu = 1/2 [Dimitriadis et al. 2002]
    const double layer = 1 + 1.133 * chi + 1.283 * chi * chi + 0.769 * std::pow(chi, 3) + 0.0975 * std::pow(chi, 4);
    const double hertz = 4. / 3 * E / (1 - nu * nu) * std::sqrt(R) * std::pow(d, 1.5) * layer;
    EXPECT_NEAR(-run.steps[4].pairs[0].on_slave.z(), hertz, mesh * hertz);
    const model::State& end = run.steps.back().state;
    const model::ContactHistory& tip = end.contact[0];
    double force = 0, moment = 0;
    for (std::size_t j = 0; j < tip.lambda.size(); ++j) {
        const auto node = static_cast<std::size_t>(tip.pair->slaves().node[j]);
        force -= tip.lambda[j].z();
        moment += (run.plan.model.X[node] + end.u[node]).cross(tip.lambda[j]).z();
    }
    // mu times Hertz' pressure times the radius, over the circle of that radius which carries the force
    const double radius = std::cbrt(0.75 * force * R * (1 - nu * nu) / E);
    const double sliding = 3 * std::numbers::pi / 16 * mu * force * radius;
    EXPECT_NEAR(moment, sliding, mesh * sliding);
}

/// When the front of a domino's top has moved by 4 mm, s; 0: never.
double knocked(const support::SceneRun& run, Index domino) {
    constexpr double far = 4e-3;
    const model::Body& body = run.plan.model.bodies[static_cast<std::size_t>(domino + 1)]; // the floor is first
    const auto begin = body.mesh.nodes.begin();
    const auto top = std::max_element(begin, body.mesh.nodes.end(),
                                      [](const Vec3& a, const Vec3& b) { return a.z() + a.x() < b.z() + b.x(); });
    const auto node = static_cast<std::size_t>(body.first_node + (top - begin));
    double time = 0, moved = 0;
    for (const auto& step : run.steps) {
        const double now = step.state.u[node].x();
        if (now >= far) return step.state.time - (step.state.time - time) * (now - far) / (now - moved);
        time = step.state.time;
        moved = now;
    }
    return 0;
}

TEST(Tutorials, DominoesFallAsRigidOnesDo) {
    // scripts/measure/dominoes --dt 2e-4: rigid bodies with friction and inelastic impacts, s
    const std::vector<double> rigid{0.0172, 0.1158};
    constexpr double allowed = 0.05;
    support::SceneRun run;
    support::run_scene(run, support::shipped("tutorials/dominoes.yaml"),
                       {{"stages.fall.duration", "0.125 s"}, {"stages.fall.steps", "125"}});
    for (std::size_t k = 0; k < rigid.size(); ++k)
        EXPECT_NEAR(knocked(run, static_cast<Index>(k)), rigid[k], allowed * rigid[k]) << k;
}

/// Mean over the nodes at a radius of what `value(node, radial, tangential)` is there; the axis is z.
template <class Value> double around(const model::Model& model, Index body, double radius, Value&& value) {
    const model::Body& b = model.bodies[static_cast<std::size_t>(body)];
    double sum = 0;
    int count = 0;
    for (Index i = 0; i < b.nodes(); ++i) {
        const Vec3& X = model.X[b.first_node + i];
        const double r = std::hypot(X.x(), X.y());
        if (std::abs(r - radius) > 1e-6 * radius) continue;
        const Vec3 radial(X.x() / r, X.y() / r, 0);
        sum += value(i, radial, Vec3(-radial.y(), radial.x(), 0));
        ++count;
    }
    return sum / count;
}

TEST(Tutorials, PressFitHasLamesPressureAndSlipsAtItsFriction) {
    constexpr double a = 15e-3, b = 30e-3, c = 50e-3, length = 30e-3, interference = 0.03e-3, mu = 0.15;
    constexpr double steel = 210e9, nu_steel = 0.3, aluminium = 70e9, nu_aluminium = 0.33;
    constexpr double mesh = 0.01;
    constexpr double hoop_mesh =
        0.02;                         // stresses at nodes are extrapolated from inside the wall, here 16 elements thick
    constexpr double squeezed = 0.01; // the push shortens shaft and hub, which changes the pressure by some 0.3 %
    constexpr Index hub = 1;
    support::SceneRun run;
    support::run_scene(run, support::shipped("tutorials/press_fit.yaml"));
    const model::Model& model = run.plan.model;
    const auto radial = [&](const support::RunStep& step, double radius) {
        const Index first = model.bodies[hub].first_node;
        return around(model, hub, radius,
                      [&](Index i, const Vec3& n, const Vec3&) { return step.state.u[first + i].dot(n); });
    };
    ASSERT_EQ(run.steps.size(), 8u) << "heat, cool and six of push";
    const support::RunStep &hot = run.steps[0], &cold = run.steps[1], &out = run.steps.back();

    EXPECT_NEAR(radial(hot, b), 23e-6 * 150 * b, 1e-9 * b) << "free to expand, though it is drawn inside the shaft";
    // Lame's rings, open at their ends
    const double wider = (c * c + b * b) / (c * c - b * b), narrower = (b * b + a * a) / (b * b - a * a);
    const double p = interference / b / ((wider + nu_aluminium) / aluminium + (narrower - nu_steel) / steel);
    const double seat = std::numbers::pi / 2 * b * length;
    EXPECT_NEAR(cold.pairs[0].normal, p * seat, mesh * p * seat);
    EXPECT_LT(cold.pairs[0].friction, 1e-6 * p * seat);
    const double rim = 2 * p * b * b * c / (aluminium * (c * c - b * b));
    EXPECT_NEAR(radial(cold, c), rim, mesh * rim);
    const auto stress = model::nodal_stress(model, hub, cold.state);
    const double hoop = around(model, hub, b, [&](Index i, const Vec3&, const Vec3& t) {
        return stress(i, 0) * t.x() * t.x() + stress(i, 1) * t.y() * t.y() + 2 * stress(i, 3) * t.x() * t.y();
    });
    EXPECT_NEAR(hoop, p * wider, hoop_mesh * p * wider);

    EXPECT_NEAR(out.pairs[0].on_slave.z(), mu * p * seat, squeezed * mu * p * seat);
    EXPECT_NEAR(out.pairs[0].friction, mu * out.pairs[0].normal, 1e-6 * mu * p * seat) << "all of it slips";
    EXPECT_LT(run.steps[2].pairs[0].on_slave.z(), 0.5 * mu * p * seat) << "it holds before";
}

TEST(Tutorials, BoltedJointFollowsItsDiagramUntilItOpens) {
    constexpr double preload = 5e3, height = 60e-3, outer = 12e-3, bore = 6.5e-3, aluminium = 70e9;
    constexpr double round_off = 1e-6, digits = 1e-5; // of the place where the bolt is locked
    constexpr double bars = 0.02; // plates are not quite bars: the head presses them more at the bore than at the rim
    support::SceneRun run;
    support::run_scene(run, support::shipped("tutorials/bolted_joint.yaml"));
    const auto bolt = [&](const support::RunStep& step) { return -step.pairs[0].on_slave.z(); };
    const auto joint = [&](const support::RunStep& step) { return step.pairs[1].on_slave.z(); };
    ASSERT_EQ(run.steps.size(), 22u);
    const support::RunStep &tight = run.steps[0], &locked = run.steps[1];
    EXPECT_NEAR(bolt(tight), preload, round_off * preload);
    EXPECT_NEAR(joint(tight), preload, round_off * preload);
    EXPECT_NEAR(bolt(locked), preload, digits * preload) << "held where the force has pulled it";
    EXPECT_NEAR(-locked.held_force.back().z(), bolt(locked), round_off * preload);

    // the upper plate's volume, a quarter of a prism with 48 sides, times the body force
    const double corner = std::numbers::pi / 24;
    const double pull = 5e9 * 12 * std::sin(corner) / 2 * (outer * outer - bore * bore) * height / 2;
    // bolt and plates as springs in series; the load goes in over the height of the upper of two equal plates
    const double both = 0.107941e-3 / preload,
                 plates = height / (aluminium * std::numbers::pi / 4 * (outer * outer - bore * bore));
    const double share = 0.75 * plates / both;
    int closed = 0, open = 0;
    for (std::size_t k = 2; k < 18; ++k) {
        const support::RunStep& step = run.steps[k];
        const double load = (step.time - 2) * pull;
        EXPECT_NEAR(bolt(step) - joint(step), load, round_off * preload) << step.time;
        EXPECT_NEAR(-step.held_force.back().z(), bolt(step), round_off * preload) << step.time;
        if (load < 0.95 * preload / (1 - share)) {
            EXPECT_NEAR((bolt(step) - preload) / load, share, bars * share) << step.time;
            ++closed;
        }
        if (load > 1.05 * preload / (1 - share)) {
            EXPECT_EQ(joint(step), 0) << step.time;
            ++open;
        }
    }
    EXPECT_GE(closed, 8);
    EXPECT_GE(open, 5);
    EXPECT_NEAR(bolt(run.steps.back()), bolt(locked), round_off * preload);
    EXPECT_NEAR(joint(run.steps.back()), bolt(locked), round_off * preload);
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
