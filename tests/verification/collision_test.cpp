/// Nothing flies through a thin plate, however long the steps (configs/validation/plate_impact.yaml), and what passes by, or
/// lands on a smooth surface, is left alone.

#include "osculate/app/run.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <algorithm>
#include <fstream>
#include <functional>
#include <gtest/gtest.h>
#include <limits>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

using Overrides = std::vector<scene::Override>;

struct Shot final : time::StepObserver {
    Timings timings;
    app::Plan plan;
    std::vector<time::Attempt> attempts;
    std::vector<model::State> states;
    long paths = 0;

    void attempted(const time::Attempt& attempt, const std::vector<equilibrium::IterationRecord>&) override {
        attempts.push_back(attempt);
    }
    void accepted(const time::AcceptedStep& step) override { states.push_back(step.state); }
    [[nodiscard]] const time::Attempt* first(time::Reason reason) const {
        const auto found = std::ranges::find(attempts, reason, &time::Attempt::reason);
        return found == attempts.end() ? nullptr : &*found;
    }
    /// Cuts by gaps and paths.
    [[nodiscard]] long cuts() const {
        return std::ranges::count_if(attempts, [](const time::Attempt& a) {
            return a.reason == time::Reason::interpenetration || a.reason == time::Reason::collision;
        });
    }
};

void run(Shot& shot, const scene::Scene& scene, const std::function<void(app::Plan&)>& change = {}) {
    shot.plan = app::compile(scene, app::build_meshes(scene), 1, shot.timings);
    if (change) change(shot.plan);
    time::Stepper stepper(shot.plan.model, shot.plan.stages, shot.plan.stepper, shot.timings);
    stepper.run(shot);
    shot.paths = stepper.counts().paths_followed;
}

void shoot(Shot& shot, const Overrides& overrides, const std::function<void(app::Plan&)>& change = {}) {
    run(shot, scene::read_scene(support::shipped("validation/plate_impact.yaml"), overrides), change);
}

/// Height above the plate's upper face of a point over it, along z, from the face's triangles; nothing beside it.
std::optional<double> height(const Shot& shot, const std::vector<Vec3>& u, const Vec3& s) {
    const model::Model& m = shot.plan.model;
    const auto x = [&](Index node) -> Vec3 { return m.X[node] + u[node]; };
    for (const mesh::Facet& facet : mesh::exterior_facets(m.bodies[0].mesh)) {
        if (mesh::facet_normal(facet, m.X).z() < 0.9) continue; // the plate is the first body
        for (int c = 1; c + 1 < facet.count; ++c) {
            const Vec3 a = x(facet.nodes[0]), b = x(facet.nodes[c]) - a, d = x(facet.nodes[c + 1]) - a, e = s - a;
            const double area = b.x() * d.y() - b.y() * d.x();
            const double v = (e.x() * d.y() - e.y() * d.x()) / area, w = (b.x() * e.y() - b.y() * e.x()) / area;
            if (v >= 0 && w >= 0 && v + w <= 1) return e.z() - v * b.z() - w * d.z();
        }
    }
    return std::nullopt;
}

/// The least height of the cube's lower face over the plate in accepted states; only where it is over it.
double lowest(const Shot& shot) {
    double least = std::numeric_limits<double>::infinity();
    const model::Model& m = shot.plan.model;
    for (const model::State& state : shot.states)
        for (const Index node : m.pairs[0]->slaves().node)
            if (const auto h = height(shot, state.u, m.X[node] + state.u[node])) least = std::min(least, *h);
    return least;
}

constexpr double allowed = 0.25e-3; // m: a twentieth of a facet of 5 mm, which is also a quarter of the thickness
/// The cube starts beside the plate, beyond the boundary of the upper face, comes in over it and flies on through it, all within
/// one step.
const Overrides from_beside{{"bodies.cube.mesh.block.origin", "[51 mm, -5 mm, 3.5 mm]"},
                            {"bodies.cube.initial_velocity", "[-800, 0, -200]"},
                            {"sets.target", "{body: plate, surface: z_max}"},
                            {"stages.impact.duration", "0.1 ms"},
                            {"stages.impact.steps", "1"}};

TEST(PlateImpact, IsStoppedByThePlateAndTheDiarySaysSo) {
    Shot shot;
    shoot(shot, {});
    EXPECT_GT(lowest(shot), -allowed);
    const time::Attempt* cut = shot.first(time::Reason::interpenetration);
    if (cut == nullptr) cut = shot.first(time::Reason::collision);
    ASSERT_NE(cut, nullptr) << "nothing was cut";
    EXPECT_EQ(cut->verdict, time::Verdict::retry);
    EXPECT_EQ(cut->body, "cube");
    EXPECT_GE(cut->node, 0);
    double upward = 0; // of the cube's centre, at the end
    const model::Body& cube = shot.plan.model.bodies[1];
    for (Index i = 0; i < cube.nodes(); ++i) upward += shot.states.back().v[cube.first_node + i].z() / cube.nodes();
    EXPECT_GT(upward, 0) << "it bounces off";
}

TEST(PlateImpact, FliesThroughWhereNothingBoundsTheStep) {
    Shot shot; // in one step so deep that the solution with contact, which looks at its end only, does not pull it back
    shoot(shot, {{"stages.impact.duration", "0.2 ms"}, {"stages.impact.steps", "1"}}, [](app::Plan& plan) {
        plan.stages[0].limits.allowed_interpenetration = std::numeric_limits<double>::infinity();
    });
    EXPECT_LT(lowest(shot), -5e-3);
}

TEST(PlateImpact, IsStoppedByItsPathWhereItStartsOutOfReach) {
    Shot shot;
    shoot(shot, from_beside);
    EXPECT_GT(lowest(shot), -allowed);
    const time::Attempt* cut = shot.first(time::Reason::collision);
    ASSERT_NE(cut, nullptr);
    EXPECT_EQ(cut->body, "cube");
    EXPECT_NEAR(cut->value * cut->dt, 17.5e-6, 0.05 * 17.5e-6) << "3.5 mm at 200 m/s";

    Shot without;
    shoot(without, from_beside, [](app::Plan& plan) { plan.stages[0].follow_paths = false; });
    EXPECT_LT(lowest(without), -5e-3) << "gaps alone do not see it";
}

/// A facet would be far behind the plate: the thickness bounds what is allowed.
TEST(PlateImpact, AllowsNoMoreThanAQuarterOfTheThickness) {
    for (const char* g_p : {"1", "5 mm"})
        for (const bool deeper : {false, true}) {
            Shot shot; // 3.5 mm and 0.2 or 0.3 mm more at 100 m/s
            shoot(shot, {{"stages.impact.duration", deeper ? "38 us" : "37 us"},
                         {"stages.impact.steps", "1"},
                         {"stages.impact.control.allowed_interpenetration", g_p}});
            EXPECT_EQ(shot.cuts() > 0, deeper) << g_p;
        }
}

TEST(PlateImpact, TakesTheAllowanceInMetres) {
    const auto cuts_with = [](const char* g_p) {
        Shot shot; // into the plate by 0.1 mm at the end of the first step
        shoot(shot, {{"stages.impact.duration", "36 us"},
                     {"stages.impact.steps", "1"},
                     {"stages.impact.control.allowed_interpenetration", g_p}});
        return shot.cuts();
    };
    EXPECT_EQ(cuts_with("0.12 mm"), 0);
    EXPECT_GT(cuts_with("0.08 mm"), 0);
    EXPECT_EQ(cuts_with("0.024"), 0); // of 5 mm
    EXPECT_GT(cuts_with("0.016"), 0);
}

TEST(PlateImpact, LeavesACubeAloneThatPassesBy) {
    const Overrides one_step{{"stages.impact.duration", "0.1 ms"}, {"stages.impact.steps", "1"}};
    const Overrides beside{{"bodies.cube.mesh.block.origin", "[50.5 mm, -5 mm, 3.5 mm]"}};
    const Overrides over_the_edge{{"bodies.cube.mesh.block.origin", "[41 mm, -5 mm, 3.5 mm]"},
                                  {"bodies.cube.initial_velocity", "[300, 0, -100]"}};
    for (const Overrides& path : {beside, over_the_edge})
        for (const char* target :
             {"{body: plate, surface: z_max}", "{body: plate, box: {min: [-1 m, -1 m, -1 m], max: [1 m, 1 m, 1 m]}}"}) {
            Overrides all = one_step;
            all.insert(all.end(), path.begin(), path.end());
            all.emplace_back("sets.target", target);
            Shot shot;
            shoot(shot, all);
            EXPECT_EQ(shot.cuts(), 0) << target;
            EXPECT_LT(shot.states.back().u.values().back().z(), -9.9e-3);
        }
}

/// A block falls far and fast into a coarse trough. The smooth surface runs up to 2 % of a facet behind its facets, many times
/// what is allowed: the gap tells that nothing has been gone through.
TEST(SmoothTrough, IsNoCollisionWhereTheGapIsAllowed) {
    const char* text = R"(
bodies:
  trough:
    mesh: {half_tube: {inner_radius: 3 m, thickness: 1 m, length: 8 m, divisions: [9, 8, 1]}}
    material: {linear_elastic: {E: 3 GPa, nu: 0.2, density: 2000 kg/m^3}}
  block:
    mesh: {block: {origin: [-0.4 m, 3.3 m, -1.5 m], size: [1 m, 1 m, 0.5 m], divisions: [4, 4, 2]}}
    material: {linear_elastic: {E: 1 GPa, nu: 0.2, density: 1000 kg/m^3}}
    initial_velocity: [0, 0, -10 m/s]
sets:
  inside: {body: trough, surface: inner}
  outside: {body: trough, surface: outer}
  face: {body: block, surface: z_min}
supports: {outside: {fix: [x, y, z]}}
contact: {landing: {slave: face, master: {set: inside}}}
stages:
  fall:
    analysis: dynamic
    duration: 0.2 s
    steps: 1
    control: {allowed_interpenetration: 1e-3}
solver: {smallest_step: 1e-6}
)";
    Shot shot;
    run(shot, scene::parse_scene(text, "trough.yaml"));
    EXPECT_GT(shot.paths, 0);
    EXPECT_NE(shot.first(time::Reason::interpenetration), nullptr);
    EXPECT_EQ(shot.first(time::Reason::collision), nullptr);
}

TEST(PlateImpact, FollowsNoPathWhereStepsAreShort) {
    Shot shot; // 0.15 mm a step, a quarter of 1 mm is the reach
    shoot(shot, {{"stages.impact.duration", "30 us"}, {"stages.impact.steps", "20"}});
    EXPECT_EQ(shot.cuts(), 0);
    EXPECT_EQ(shot.paths, 0);
    Shot longer;
    shoot(longer, {{"stages.impact.duration", "0.1 ms"}, {"stages.impact.steps", "1"}});
    EXPECT_GT(longer.paths, 0);
}

TEST(PlateImpact, WritesWhatStoppedItIntoTheDiary) {
    app::RunOptions options;
    options.directory = support::temporary("plate_impact");
    options.quiet = true;
    app::run(support::shipped("validation/plate_impact.yaml"),
             {{"stages.impact.duration", "0.1 ms"}, {"stages.impact.steps", "1"}}, options);
    std::ifstream steps(options.directory / "steps.csv");
    const std::string text{std::istreambuf_iterator<char>(steps), {}};
    EXPECT_TRUE(text.find("retry,interpenetration,cube,") != std::string::npos ||
                text.find("retry,collision,cube,") != std::string::npos)
        << text;
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
