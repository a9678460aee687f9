/// Couplings: beams bent by moments, the same motion by supports, turned scenes, dynamics, and what a run keeps.

#include "osculate/output/checkpoint_file.hpp"
#include "support/diary.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"
#include "support/source_tree.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

support::SceneRun run(const std::string& text) {
    support::SceneRun result;
    support::run_scene(result, support::scene_file("coupling.yaml", text));
    return result;
}

Vec3 displacement(const support::SceneRun& run, const support::RunStep& step, std::size_t k = 0) {
    return step.state.u[static_cast<std::size_t>(run.plan.model.rigid[k].reference)];
}

// ---- beams -----------------------------------------------------------------------------------------------------------

/// A cantilever of 2 m with a square section of 0.1 m, E = 1 GPa, nu = 0. The incompatible modes bend exactly.
std::string cantilever(const std::string& coupling, const std::string& stage) {
    return R"(
bodies:
  beam:
    mesh: {block: {origin: [0, -0.05, -0.05], size: [2, 0.1, 0.1], divisions: [10, 1, 1]}}
    material: {linear_elastic: {E: 1 GPa, nu: 0}}
    hex_formulation: incompatible_modes
sets:
  root: {body: beam, surface: x_min}
  tip: {body: beam, surface: x_max}
supports:
  root: {fix: [x, y, z]}
couplings:
  head: )" +
           coupling + "\nstages:\n  bend: " + stage + "\n";
}
constexpr double EI = 1e9 * 1e-4 / 12, L = 2;

TEST(Coupling, BendsABeamByAMomentAsTheorySays) {
    const support::SceneRun bent = run(cantilever("{set: tip}", "{moment: {head: [0, 0.1, 0]}}"));
    const support::RunStep& last = bent.steps.back();
    const double angle = 0.1 * L / EI; // 2.4e-5 rad: the square of it is all that is left out
    EXPECT_NEAR(last.state.rigid[0].rotation.y(), angle, 1e-6 * angle);
    EXPECT_NEAR(displacement(bent, last).z(), -angle * L / 2, 1e-6 * angle * L);
    EXPECT_LT(last.reactions[0].norm(), 1e-9);
}

TEST(Coupling, TakesTheMomentThatItsRotationAsksFor) {
    const support::SceneRun bent = run(cantilever("{set: tip, fix: [y, rx, rz]}", "{motion: {head: {ry: 1e-5 rad}}}"));
    const support::RunStep& last = bent.steps.back();
    const double moment = EI / L * 1e-5;
    EXPECT_NEAR(last.held_moment[0].y(), moment, 1e-5 * moment);
    EXPECT_LT(last.held_force[0].norm(), 1e-6 * moment / L);
}

/// Tractions of beam theory: N/A and M z/I, which elements with midside nodes and nu = 0 answer exactly.
TEST(DistributingCoupling, LoadsABeamAsTheorySays) {
    for (const char* element : {"hex20", "hex8", "wedge15", "tet10"}) {
        std::string text = cantilever("{set: tip, reference_point: [3, 0.2, 0.1]}",
                                      "{force: {head: [1, 0, 0]}, moment: {head: [0, 0, 0.1]}}");
        text.erase(text.find("    hex_formulation"), text.find("sets:") - text.find("    hex_formulation"));
        support::SceneRun bent;
        support::run_scene(bent, support::scene_file("coupling.yaml", text),
                           {{"couplings.head.kind", "distributing"},
                            {"bodies.beam.mesh.block.divisions", "[10, 2, 2]"},
                            {"bodies.beam.mesh.block.element", element}});
        const support::RunStep& last = bent.steps.back();
        EXPECT_TRUE(bent.plan.model.rigid.empty());
        // F is 0.2 m and 0.1 m beside the axis: M_y = 0.1, M_z = 0.1 - 0.2
        const double stretch = 1 / 1e7, k_y = 0.1 / EI, k_z = -0.1 / EI;
        const bool exact = std::string(element) != "hex8";
        double largest = 0;
        for (Index n = 0; n < bent.plan.model.nodes(); ++n) {
            const Vec3 X = bent.plan.model.X[static_cast<std::size_t>(n)] + bent.plan.model.origin;
            const Vec3 u(stretch * X.x() + k_y * X.x() * X.z() - k_z * X.x() * X.y(), k_z * X.x() * X.x() / 2,
                         -k_y * X.x() * X.x() / 2);
            largest = std::max(largest, (last.state.u[static_cast<std::size_t>(n)] - u).norm());
        }
        if (exact) {
            EXPECT_LT(largest, 1e-9 * k_y * L * L) << element;
        }
        EXPECT_LT((last.reactions[0] + Vec3(1, 0, 0)).norm(), 1e-9) << element;
    }
}

TEST(DistributingCoupling, IsRefusedWhereSharesOfTheUndeformedBodyAreWrong) {
    const std::string text = cantilever("{set: tip, kind: distributing}", "{moment: {head: [0, 0.1, 0]}}");
    const auto refusal = [&](const char* key, const char* value, const char* other, const char* with) -> std::string {
        try {
            support::SceneRun result;
            support::run_scene(result, support::scene_file("coupling.yaml", text), {{key, value}, {other, with}});
        } catch (const std::exception& error) {
            return error.what();
        }
        return "none";
    };
    EXPECT_NE(
        refusal("bodies.beam.material", "{neo_hookean: {E: 1 GPa, nu: 0.3}}", "bodies.beam.hex_formulation", "full")
            .find("couplings.head.kind: expected rigid"),
        std::string::npos);
    EXPECT_NE(refusal("bodies.beam.slice", "{kind: plane_stress}", "supports.root.fix", "[x, y]")
                  .find("couplings.head.set: expected a set of a body that is no slice"),
              std::string::npos);
}

/// Without faces nodes have equal shares: statics alone, for forces in every direction.
TEST(DistributingCoupling, SharesLoadsAmongNodes) {
    std::string text = cantilever("{set: some, kind: distributing, reference_point: [2.5, 0.3, 0.1]}",
                                  "{force: {head: [{table: [[0, 0], [1, 2]]}, 3, -1]}, moment: {head: [1, 2, 3]}}");
    text.replace(text.find("  tip:"), 6, "  some: {body: beam, box: {min: [1.3, -1, -1], max: [1.7, 1, 0]}}\n  tip:");
    const support::SceneRun bent = run(text);
    const support::RunStep& last = bent.steps.back();
    EXPECT_LT((last.reactions[0] + Vec3(2, 3, -1)).norm(), 1e-8);
    // moments about the root's centre
    const Vec3 about = Vec3(2.5, .3, .1).cross(Vec3(2, 3, -1)) + Vec3(1, 2, 3);
    Vec3 moment = Vec3::Zero();
    const Field force = bent.plan.stages[0].force(bent.plan.model.X.size(), 1);
    for (Index n = 0; n < bent.plan.model.nodes(); ++n)
        moment += (bent.plan.model.X[static_cast<std::size_t>(n)] + bent.plan.model.origin)
                      .cross(force[static_cast<std::size_t>(n)]);
    EXPECT_LT((moment - (about - Vec3(2.5, .3, .1).cross(Vec3(2, 0, 0)))).norm(), 1e-9) << "x follows its course";
}

/// A force at a reference point away from the section is a force and a moment on it; the supports answer.
TEST(Coupling, CarriesAForceBesideTheSection) {
    const support::SceneRun bent =
        run(cantilever("{set: tip, reference_point: [3, 0, 0]}", "{force: {head: [0, 0, 0.1]}}"));
    const support::RunStep& last = bent.steps.back();
    // with 1 m of a rigid lever: M(x) = F (3 - x)
    const double F = 0.1, angle = F * (3 * L - L * L / 2) / EI, tip = F * (3 * L * L / 2 - L * L * L / 6) / EI;
    EXPECT_NEAR(last.state.rigid[0].rotation.y(), -angle, 1e-5 * angle);
    constexpr double shear = 2e-3; // of the deflection: Timoshenko's part, and a linear moment over an element
    EXPECT_NEAR(displacement(bent, last).z(), tip + angle, shear * (tip + angle));
    EXPECT_NEAR(last.reactions[0].z(), -F, 1e-8 * F);
}

TEST(Coupling, RollsABeamUpIntoACircle) {
    const support::SceneRun rolled = run(R"(
bodies:
  beam:
    mesh: {block: {origin: [0, -0.05, -0.05], size: [4, 0.1, 0.1], divisions: [40, 1, 1], element: tet10}}
    material: {saint_venant_kirchhoff: {E: 1 GPa, nu: 0}}
sets:
  root: {body: beam, surface: x_min}
  tip: {body: beam, surface: x_max}
supports:
  root: {fix: [x, y, z]}
couplings:
  head: {set: tip}
stages:
  bend: {steps: 15, moment: {head: [0, )" +
                                         std::to_string(2 * std::numbers::pi * EI / 4) + ", 0]}}\n");
    const support::RunStep& last = rolled.steps.back();
    constexpr double finite_strain = 0.02; // strains of 8 percent at the outer fibres, of Green's measure
    EXPECT_NEAR(last.state.rigid[0].rotation.y(), 2 * std::numbers::pi, finite_strain * 2 * std::numbers::pi);
    EXPECT_LT((displacement(rolled, last) + Vec3(4, 0, 0)).norm(), finite_strain * 4);
    for (const support::RunStep& step : rolled.steps) EXPECT_LT(step.iterations, 12) << "the tangent is exact";
}

// ---- the same in other words -------------------------------------------------------------------------------------------

const char* const block = R"(
bodies:
  block:
    mesh: {block: {size: [1, 0.8, 0.6], divisions: [4, 3, 3]}}
    material: {neo_hookean: {E: 1 MPa, nu: 0.3}}
sets:
  bottom: {body: block, surface: z_min}
  top: {body: block, surface: z_max}
)";

TEST(Coupling, MovesAsSupportsWould) {
    const support::SceneRun coupled = run(std::string(block) + R"(
supports:
  bottom: {fix: [x, y, z]}
couplings:
  head: {set: top, reference_point: [0.2, 0.1, 0.9], fix: [rx, ry, rz]}
stages:
  move: {steps: 3, motion: {head: {x: 10 cm, y: -5 cm, z: 8 cm}}}
)");
    const support::SceneRun held = run(std::string(block) + R"(
supports:
  bottom: {fix: [x, y, z]}
stages:
  move: {steps: 3, displacement: {top: {x: 10 cm, y: -5 cm, z: 8 cm}}}
)");
    const support::RunStep &a = coupled.steps.back(), &b = held.steps.back();
    for (std::size_t i = 0; i < b.state.u.size(); ++i)
        EXPECT_LT((a.state.u[i] - b.state.u[i]).norm(), 1e-9) << "node " << i;
    EXPECT_LT((a.held_force[0] - b.reactions[1]).norm(), 1e-8 * b.reactions[1].norm());
    // the moments of all forces on the body balance, about the reference point
    const model::Model& model = held.plan.model;
    const Vec3 point = Vec3(0.2, 0.1, 0.9) - model.origin + Vec3(0.1, -0.05, 0.08);
    const Field f = model::internal_force(model, b.state.at_rest(), 1);
    Vec3 moment = Vec3::Zero();
    for (const Index node : model.sets[1].nodes) {
        const auto i = static_cast<std::size_t>(node);
        moment += (model.X[i] + b.state.u[i] - point).cross(f[i]);
    }
    EXPECT_LT((a.held_moment[0] - moment).norm(), 1e-7 * moment.norm());
}

/// Turned about an oblique axis, with a large turn of the coupling about another one on top.
TEST(Coupling, GivesTheTurnedAnswerOfATurnedScene) {
    const auto of = [](const Mat3& Q) {
        const auto text = [&](const Vec3& v) {
            const Vec3 w = Q * v;
            char digits[120];
            std::snprintf(digits, sizeof digits, "[%.17g, %.17g, %.17g]", w.x(), w.y(), w.z());
            return std::string(digits);
        };
        const Eigen::AngleAxisd turn(Q);
        char placed[200];
        std::snprintf(placed, sizeof placed, "rotate: {axis: [%.17g, %.17g, %.17g], angle: %.17g}", turn.axis().x(),
                      turn.axis().y(), turn.axis().z(), turn.angle());
        return run(R"(
bodies:
  beam:
    mesh: {block: {size: [3, 0.5, 0.4], divisions: [9, 2, 2]}, )" +
                   std::string(placed) + R"(}
    material: {neo_hookean: {E: 1 MPa, nu: 0.3}}
sets:
  root: {body: beam, surface: x_min}
  tip: {body: beam, surface: x_max}
supports:
  root: {fix: [x, y, z]}
couplings:
  head: {set: tip, reference_point: )" +
                   text(Vec3(3.2, 0.1, 0.3)) + R"(}
stages:
  twist: {steps: 6, moment: {head: )" +
                   text(Vec3(1000, 600, -500)) + "}, force: {head: " + text(Vec3(0, 200, 500)) + "}}\n");
    };
    const Mat3 Q = Eigen::AngleAxisd(1.1, Vec3(1, 2, -1).normalized()).toRotationMatrix();
    const support::SceneRun straight = of(Mat3::Identity()), turned = of(Q);
    const support::RunStep &a = straight.steps.back(), &b = turned.steps.back();
    EXPECT_GT(a.state.rigid[0].rotation.norm(), 0.7);
    EXPECT_LT((b.state.rigid[0].rotation - Q * a.state.rigid[0].rotation).norm(), 1e-7);
    EXPECT_LT((displacement(turned, b) - Q * displacement(straight, a)).norm(), 1e-7);
}

// ---- dynamics ----------------------------------------------------------------------------------------------------------

/// Of finite strain, and free: energy and both momenta stay what they are, though a face is held flat.
TEST(Coupling, KeepsEnergyAndMomentaOfAFreeBody) {
    const support::SceneRun free = run(R"(
bodies:
  block:
    mesh: {block: {size: [1, 0.8, 0.6], divisions: [3, 2, 2]}}
    material: {saint_venant_kirchhoff: {E: 1 MPa, nu: 0.3, density: 1000}}
    initial_velocity: [0.3, 0.1, -0.2]
    initial_spin: [1, 3, 0.5]
sets:
  top: {body: block, surface: z_max}
couplings:
  head: {set: top}
stages:
  spin:
    analysis: {dynamic: {integrator: {generalised_alpha: {rho_inf: 1}}}}
    control: {step_size: fixed}
    duration: 3
    steps: 300
solver: {tolerance: 1e-12}
)");
    const time::Ledger& first = free.steps.front().ledger;
    const double energy = first.kinetic + first.strain;
    for (const support::RunStep& step : free.steps) {
        ASSERT_NEAR(step.ledger.kinetic + step.ledger.strain, energy, 1e-8 * energy);
        ASSERT_LT((step.ledger.linear - first.linear).norm(), 1e-8 * first.linear.norm());
        ASSERT_LT((step.ledger.angular - first.angular).norm(), 1e-8 * first.angular.norm());
    }
    EXPECT_GT(free.steps.back().state.rigid[0].rotation.norm(), 2);
}

/// A stiff bar hung from a coupling of its end: the pendulum of rigid_body_test.
TEST(Coupling, SwingsAPendulumInItsPeriod) {
    for (const char* mass : {"consistent", "lumped"}) {
        SCOPED_TRACE(mass);
        const support::SceneRun bar = run(R"(
gravity: [0, 0, -9.81]
bodies:
  bar:
    mesh: {block: {origin: [0, -0.05, -0.05], size: [1, 0.1, 0.1], divisions: [10, 1, 1]}}
    material: {saint_venant_kirchhoff: {E: 1 GPa, nu: 0.3, density: 1000}}
sets:
  end: {body: bar, surface: x_min}
couplings:
  pivot: {set: end, fix: [x, y, z]}
stages:
  swing: {analysis: {dynamic: {mass: )" + std::string(mass) +
                                          R"(}}, duration: 2.2 s, steps: 220}
)");
        std::vector<double> passed; // the lowest place
        for (std::size_t k = 1; k < bar.steps.size(); ++k) {
            const auto left = [&](std::size_t i) {
                return bar.steps[i].state.rigid[0].rotation.y() - std::numbers::pi / 2;
            };
            if (left(k - 1) * left(k) >= 0) continue;
            const double share = left(k - 1) / (left(k - 1) - left(k));
            passed.push_back(bar.steps[k - 1].time + share * (bar.steps[k].time - bar.steps[k - 1].time));
        }
        ASSERT_EQ(passed.size(), 2U);
        const double period = 4 * std::sqrt((1.01 / 12 + 0.25) / (9.81 * 0.5)) * std::comp_ellint_1(std::sqrt(0.5));
        EXPECT_NEAR(2 * (passed[1] - passed[0]), period, 0.01 * period);
        const time::Ledger& last = bar.steps.back().ledger;
        EXPECT_NEAR(last.kinetic + last.strain + last.algorithmic, last.external, 1e-3 * last.external);
        EXPECT_LT(std::abs(last.balance), 1e-8 * last.external);
    }
}

// ---- what a run keeps ----------------------------------------------------------------------------------------------------

const char* const swung = R"(
bodies:
  beam:
    mesh: {block: {size: [1, 0.2, 0.2], divisions: [5, 2, 2]}}
    material: {neo_hookean: {E: 1 MPa, nu: 0.3, density: 1000}}
sets:
  root: {body: beam, surface: x_min}
  tip: {body: beam, surface: x_max}
couplings:
  clamp: {set: root, fix: [x, y, z, rx, rz]}
  head: {set: tip}
stages:
  bend: {steps: 5, motion: {clamp: {ry: 0.4 rad}}, moment: {head: [5, -20, 3]}}
  swing: {analysis: dynamic, duration: 0.2 s, steps: 20, moment: {head: [0, 0, 0]}, ramp: step}
)";

struct Part final : time::StepObserver {
    explicit Part(std::string path = support::scene_file("swung.yaml", swung)) : file(std::move(path)) {
        const scene::Scene scene = scene::read_scene(file);
        plan = app::compile(scene, app::build_meshes(scene), 1, timings);
    }
    Part& go(const std::string* from = nullptr) {
        time::Stepper stepper(plan.model, plan.stages, plan.stepper, timings);
        if (from != nullptr) stepper.resume(output::decode(*from).run);
        stepper.run(*this);
        return *this;
    }
    void attempted(const time::Attempt& a, const std::vector<equilibrium::IterationRecord>& i) override {
        diary.attempted(a, i);
    }
    void accepted(const time::AcceptedStep& step) override { diary.accepted(step); }
    void between_steps(const std::function<time::Checkpoint()>& checkpoint) override {
        if (diary.states.size() % 7 != 3) return;
        output::CheckpointFile kept;
        kept.run = checkpoint();
        files.push_back(output::encode(kept));
    }
    std::string file; ///< of the scene
    Timings timings;
    app::Plan plan;
    support::Diary diary;
    std::vector<std::string> files;
};

TEST(ExactSurfaces, AndCouplingsGoOnFromACheckpointToTheBit) {
    const std::string scene = support::source_tree() + "/tests/scenes/exact_tools.yaml";
    const Part straight = std::move(Part(scene).go());
    ASSERT_GE(straight.files.size(), 1U);
    for (const std::string& checkpoint : straight.files) {
        Part rest(scene);
        rest.go(&checkpoint);
        support::expect_same_end(straight.diary, rest.diary);
    }
}

TEST(Coupling, GoesOnFromACheckpointToTheBit) {
    const Part straight = std::move(Part().go());
    ASSERT_GE(straight.files.size(), 3U);
    for (const std::string& file : straight.files) {
        Part rest;
        rest.go(&file);
        support::expect_same_end(straight.diary, rest.diary);
        const model::RigidMotion &a = straight.diary.states.back().rigid[1], &b = rest.diary.states.back().rigid[1];
        EXPECT_EQ(a.orientation.coeffs(), b.orientation.coeffs());
        EXPECT_EQ(a.angular_velocity, b.angular_velocity);
    }
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
