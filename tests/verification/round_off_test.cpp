/// Stiff, light bodies in friction that sticks: the last digit of a gap, times the stiffness of the bodies, is as much as the
/// forces' tolerance. They come to rest all the same, wherever the scene is.

#include "osculate/core/error.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <limits>
#include <utility>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

/// A steel block of 50 mm, 9.6 N, at rest on a steel table.
const char* const at_rest = R"(
bodies:
  table:
    mesh: {block: {origin: [-50 mm, -50 mm, -50 mm], size: [100 mm, 100 mm, 50 mm], divisions: [5, 5, 2]}}
    material: {linear_elastic: {E: 210 GPa, nu: 0.3, density: 7850 kg/m^3}}
  block:
    mesh: {block: {origin: [-25 mm, -25 mm, 0 m], size: [50 mm, 50 mm, 50 mm], divisions: [4, 4, 4]}}
    material: {linear_elastic: {E: 210 GPa, nu: 0.3, density: 7850 kg/m^3}}
gravity: [0, 0, -9.81 m/s^2]
sets:
  sole: {body: block, surface: z_min}
  head: {body: block, surface: z_max}
  ground: {body: table, surface: z_max}
  bed: {body: table, surface: z_min}
supports:
  bed: {fix: [x, y, z]}
contact:
  sole: {slave: sole, master: {set: ground}, friction: 0.3}
stages:
  rest: {}
)";

/// press_block of the tutorials, without gravity.
const char* const press = R"(
bodies:
  base:
    mesh: {block: {size: [2 m, 2 m, 0.5 m], divisions: [8, 8, 2]}}
    material: {linear_elastic: {E: 30 MPa, nu: 0.2}}
  cap:
    mesh: {block: {origin: [0.5 m, 0.5 m, 0.5 m], size: [1 m, 1 m, 0.5 m], divisions: [5, 5, 2]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0.3}}
sets:
  bed: {body: base, surface: z_min}
  ground: {body: base, surface: z_max}
  under: {body: cap, surface: z_min}
  top: {body: cap, surface: z_max}
supports:
  bed: {fix: [x, y, z]}
contact:
  sole: {slave: under, master: {set: ground}, friction: 0.3}
stages:
  press: {pressure: {top: 1 Pa}}
)";

using Changes = std::vector<scene::Override>;

struct Outcome final : time::StepObserver {
    app::Plan plan;
    Timings timings;
    model::State state; ///< accepted last
    std::string failure;
    int steps = 0, at_round_off = 0;
    double worst = 0; ///< largest component of the residual at an accepted state, of the tolerance

    explicit Outcome(const std::string& text, const Changes& changes = {}) {
        const scene::Scene scene = scene::read_scene(support::scene_file("round_off.yaml", text), changes);
        plan = app::compile(scene, app::build_meshes(scene), 1, timings);
        time::Stepper stepper(plan.model, plan.stages, plan.stepper, timings);
        try {
            stepper.run(*this);
        } catch (const RunFailure& caught) {
            failure = caught.what();
        }
        at_round_off = stepper.counts().steps_at_round_off;
    }
    void attempted(const time::Attempt&, const std::vector<equilibrium::IterationRecord>&) override {}
    void accepted(const time::AcceptedStep& step) override {
        ++steps;
        state = step.state;
    }
    [[nodiscard]] Vec3 contact_force() const {
        Vec3 sum = Vec3::Zero();
        for (const Vec3& lambda : state.contact[0].lambda) sum += lambda;
        return sum;
    }
};

Changes moved_by(double distance, const std::vector<std::string>& bodies) {
    const std::string d = fmt::format("{}", distance);
    Changes changes;
    for (const std::string& body : bodies)
        changes.push_back({"bodies." + body + ".mesh.translate", fmt::format("[{}, {}, {}]", d, d, d)});
    return changes;
}

double largest(const std::vector<Vec3>& forces) {
    double most = 0;
    for (const Vec3& f : forces) most = std::max(most, f.norm());
    return most;
}

TEST(RoundOff, ABlockAtRestCarriesTheSameForcesWhereverItIs) {
    const Outcome here(at_rest);
    ASSERT_EQ(here.failure, "");
    const std::vector<Vec3>& forces = here.state.contact[0].lambda;
    constexpr double weight = 7850 * 9.81 * 1.25e-4, same = 1e-9;
    EXPECT_NEAR(here.contact_force().z(), weight, same * weight);
    for (const double distance : {0.03, 0.07, 0.1, 0.2, 0.3, 0.5, 1.0, 3.0, 10.0, 100.0}) {
        const Outcome there(at_rest, moved_by(distance, {"table", "block"}));
        ASSERT_EQ(there.failure, "") << distance << " m";
        double off = 0;
        for (std::size_t j = 0; j < forces.size(); ++j)
            off = std::max(off, (there.state.contact[0].lambda[j] - forces[j]).norm());
        EXPECT_LE(off, same * largest(forces)) << distance << " m";
    }
}

class AveragingBlock : public testing::TestWithParam<const char*> {};

TEST_P(AveragingBlock, AtRestCarriesTheSameForcesWhereverItIs) {
    std::string text = at_rest;
    text.replace(text.find("friction: 0.3"), 13, std::string("friction: 0.3, discretisation: ") + GetParam());
    const Outcome here(text);
    ASSERT_EQ(here.failure, "");
    const std::vector<Vec3>& forces = here.state.contact[0].lambda;
    constexpr double same = 1e-9;
    for (const double distance : {0.03, 0.07, 0.1, 0.2, 0.3, 0.5, 1.0, 3.0, 10.0, 100.0}) {
        const Outcome there(text, moved_by(distance, {"table", "block"}));
        ASSERT_EQ(there.failure, "") << distance << " m";
        double off = 0;
        for (std::size_t j = 0; j < forces.size(); ++j)
            off = std::max(off, (there.state.contact[0].lambda[j] - forces[j]).norm());
        EXPECT_LE(off, same * largest(forces)) << distance << " m";
    }
}

INSTANTIATE_TEST_SUITE_P(By, AveragingBlock, testing::Values("mortar", "petrov_galerkin"),
                         [](const auto& tested) { return std::string(tested.param); });

TEST(RoundOff, AStiffBlockUnderALightPressureComesToRestWhereverItIs) {
    std::string text = at_rest;
    text.replace(text.find("gravity"), std::string("gravity: [0, 0, -9.81 m/s^2]").size(), "");
    text.replace(text.find("rest: {}"), 8, "rest: {pressure: {head: 10 kPa}}");
    for (auto at = text.find("50 mm"); at != std::string::npos; at = text.find("50 mm", at))
        text.replace(at, 5, "0.1 m");
    for (auto at = text.find("-25 mm"); at != std::string::npos; at = text.find("-25 mm", at))
        text.replace(at, 6, "-50 mm");
    for (auto at = text.find("100 mm"); at != std::string::npos; at = text.find("100 mm", at))
        text.replace(at, 6, "0.2 m");
    for (const double distance : {0.0, 0.03, 0.1, 0.3, 0.5, 1.0, 10.0}) {
        const Outcome there(text, moved_by(distance, {"table", "block"}));
        ASSERT_EQ(there.failure, "") << distance << " m";
        EXPECT_NEAR(there.contact_force().z(), 100, 1e-7) << distance << " m";
    }
}

TEST(RoundOff, ABlockStandsOnASlopeThatNoAxisOfTheMeshIsAlong) {
    std::string text = at_rest;
    text.replace(text.find("friction: 0.3"), 13, "friction: 0.2"); // tan 5.71 deg = 0.1
    for (const double distance : {0.0, 0.05, 0.3}) {
        Changes changes = moved_by(distance, {"table", "block"});
        for (const char* const body : {"table", "block"})
            changes.push_back({std::string("bodies.") + body + ".mesh.rotate", "{axis: [0, 1, 0], angle: 5.71 deg}"});
        const Outcome stands(text, changes);
        ASSERT_EQ(stands.failure, "") << distance << " m";
        EXPECT_NEAR(stands.contact_force().z(), 7850 * 9.81 * 1.25e-4, 1e-7) << distance << " m";
        EXPECT_NEAR(std::hypot(stands.contact_force().x(), stands.contact_force().y()), 0, 1e-7) << distance << " m";
    }
}

TEST(RoundOff, ABlockAtFiniteStrainComesToRest) {
    for (const char* const law : {"saint_venant_kirchhoff", "neo_hookean"}) {
        std::string text = at_rest;
        for (auto at = text.find("linear_elastic"); at != std::string::npos; at = text.find("linear_elastic", at))
            text.replace(at, 14, law);
        for (const double distance : {0.0, 0.1, 0.3}) {
            const Outcome rests(text, moved_by(distance, {"table", "block"}));
            ASSERT_EQ(rests.failure, "") << law << ", " << distance << " m";
            EXPECT_NEAR(rests.contact_force().z(), 7850 * 9.81 * 1.25e-4, 1e-6) << law << ", " << distance << " m";
        }
    }
}

TEST(RoundOff, TheTutorialsBlockMayBePressedAsLightlyAsOneLikes) {
    for (const char* const pressure : {"1 Pa", "0.1 Pa", "1e-3 Pa"}) {
        const Outcome light(press, {{"stages.press.pressure.top", pressure}});
        ASSERT_EQ(light.failure, "") << pressure;
        EXPECT_NEAR(light.contact_force().z() / std::stod(pressure), 1, 1e-7) << pressure;
    }
    for (const char* const pressure : {"1 Pa", "0.1 Pa"}) {
        const Outcome heavy(press, {{"stages.press.pressure.top", pressure},
                                    {"gravity", "[0, 0, -9.81 m/s^2]"},
                                    {"bodies.base.material.linear_elastic.density", "2000 kg/m^3"},
                                    {"bodies.cap.material.linear_elastic.density", "1000 kg/m^3"}});
        ASSERT_EQ(heavy.failure, "") << pressure;
        EXPECT_NEAR(heavy.contact_force().z(), 4905 + std::stod(pressure), 1e-4) << pressure;
    }
}

/// A steel column of 1 m, without friction, that its load moves across a gap onto a slab.
const char* const across_a_gap = R"(
bodies:
  slab:
    mesh: {{block: {{origin: [-0.1 m, -0.1 m, -0.2 m], size: [0.7 m, 0.7 m, 0.2 m], divisions: [3, 3, 1]}}}}
    material: {{linear_elastic: {{E: 200 GPa, nu: 0}}}}
  column:
    mesh: {{block: {{origin: [0 m, 0 m, {0} m], size: [0.5 m, 0.5 m, 1 m], divisions: [2, 2, 4]}}}}
    material: {{linear_elastic: {{E: 200 GPa, nu: 0}}}}
sets:
  sole: {{body: column, surface: z_min}}
  ground: {{body: slab, surface: z_max}}
  bed: {{body: slab, surface: z_min}}
supports:
  bed: {{fix: [x, y, z]}}
contact:
  joint: {{slave: {1}, master: {{set: {2}}}}}
stages:
  rest: {{body_force: {{column: [0 N/m^3, 0 N/m^3, -{3} N/m^3]}}}}
)";

TEST(RoundOff, AStiffColumnUnderALightLoadCrossesAGapAndRests) {
    constexpr double area = 0.25, stiffness = 200e9 * area / 0.25, digit = std::numeric_limits<double>::epsilon();
    for (const auto& [slave, master] : {std::pair("sole", "ground"), std::pair("ground", "sole")})
        for (const double gap : {0.003, 0.01, 0.03})
            for (const double load : {1.0, 100.0, 1e4}) {
                const std::string which = fmt::format("{} on {}, {} m, {} N/m^3", slave, master, gap, load);
                const Outcome rests(fmt::format(fmt::runtime(across_a_gap), gap, slave, master, load),
                                    moved_by(1, {"slab", "column"}));
                ASSERT_EQ(rests.failure, "") << which;
                // what the last digit of a displacement is worth at the edges of a node
                const double allowed = 10 * digit * gap * stiffness + 1e-8 * load * area;
                EXPECT_NEAR(std::abs(rests.contact_force().z()), load * area, allowed) << which;
                EXPECT_EQ(rests.steps, 1) << which;
            }
    // forces below what the last digits of displacements are worth are not found, and not passed over in silence
    const Outcome lost(fmt::format(fmt::runtime(across_a_gap), 0.03, "ground", "sole", 1e-4),
                       moved_by(1, {"slab", "column"}));
    EXPECT_TRUE(!lost.failure.empty() || lost.at_round_off == 1);
}

TEST(RoundOff, AStiffColumnThatLandsOnAnEdgeTipsUntilItStands) {
    // its load is less than the round-off of its forces; the springs that lead it to the slab have to bear it until it stands
    const Outcome stands(fmt::format(fmt::runtime(across_a_gap), 0.03, "ground", "sole", 1e-4),
                         {{"bodies.column.mesh.rotate", "{axis: [0, 1, 0], angle: 0.2 deg}"}});
    ASSERT_EQ(stands.failure, "");
    const model::Model& model = stands.plan.model;
    double lowest = 1, highest = -1; // of the four lower corners and all between
    for (const model::Set& set : model.sets)
        if (set.name == "sole")
            for (const Index node : set.nodes) {
                const double z = model.X[node].z() + stands.state.u[node].z();
                lowest = std::min(lowest, z);
                highest = std::max(highest, z);
            }
    constexpr double lifted = 0.5 * 0.2 * M_PI / 180; // before
    EXPECT_LT(highest - lowest, 1e-6 * lifted);
    EXPECT_GT(stands.at_round_off, 0);
}

TEST(RoundOff, OfAForceWithoutBoundHidesNoGap) {
    // nothing can give way, so forces grow from iteration to iteration until any gap is a last digit of them
    for (const char* discretisation : {"node", "mortar", "petrov_galerkin"}) {
        support::SceneRun run;
        EXPECT_THROW(support::run_scene(run, support::shipped("extreme/driven_through_a_wall.yaml"),
                                        {{"contact.sole.discretisation", discretisation}}),
                     RunFailure)
            << discretisation;
        for (const support::RunStep& step : run.steps)
            EXPECT_LT(step.pairs[0].penetration, 1e-6 * 0.2) << discretisation; // facets of 0.2 m
    }
}

/// A steel ball falls among four rubber ones, 42000 times as soft: what round-off leaves of its forces is more than the
/// tolerance of those that rubber presses with.
const char* const steel_on_rubber = R"(
bodies:
  box: {{mesh: {{file: {{path: "{0}"}}}}, rigid: {{density: 1000 kg/m^3, fix: [x, y, z, rx, ry, rz]}}}}
  rubber_0: {{mesh: {{ball: {{radius: 20 mm, divisions: [4, 1, 2]}}, translate: [-27 mm, -27 mm, 20.2 mm]}}, material: {1}}}
  rubber_1: {{mesh: {{ball: {{radius: 20 mm, divisions: [4, 1, 2]}}, translate: [27 mm, -27 mm, 20.2 mm]}}, material: {1}}}
  rubber_2: {{mesh: {{ball: {{radius: 20 mm, divisions: [4, 1, 2]}}, translate: [27 mm, 27 mm, 20.2 mm]}}, material: {1}}}
  rubber_3: {{mesh: {{ball: {{radius: 20 mm, divisions: [4, 1, 2]}}, translate: [-27 mm, 27 mm, 20.2 mm]}}, material: {1}}}
  steel:
    mesh: {{ball: {{radius: 20 mm, divisions: [4, 1, 2]}}, translate: [3 mm, -2 mm, 41 mm]}}
    material: {{neo_hookean: {{E: 210 GPa, nu: 0.3, density: 7850 kg/m^3}}}}
    initial_velocity: [0 m/s, 0 m/s, -1 m/s]
gravity: [0 m/s^2, 0 m/s^2, -9.81 m/s^2]
contact: {{general: {{friction: 0.3}}}}
stages:
  fall: {{analysis: dynamic, duration: 0.01 s, steps: 5}}
)";

TEST(RoundOff, OfSteelAmongRubberIsSeenAtOnce) {
    support::SceneRun run;
    const std::string text = fmt::format(fmt::runtime(steel_on_rubber), support::shipped("tutorials/meshes/box.vtu"),
                                         "{neo_hookean: {E: 5 MPa, nu: 0.4, density: 1100 kg/m^3}}");
    support::run_scene(run, support::scene_file("steel.yaml", text));
    EXPECT_NEAR(run.steps.back().time, 0.01, 1e-12);
    int worst = 0;
    for (const support::RunStep& step : run.steps) worst = std::max(worst, step.iterations);
    EXPECT_LT(worst, 50) << "they go on at round-off until they are cut, in 1000 iterations and more";
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
