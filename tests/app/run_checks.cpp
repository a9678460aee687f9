/// Checks of a run, on states whose forces, energies and gaps are known.

#include "osculate/app/run_checks.hpp"

#include "osculate/app/compile.hpp"
#include "osculate/scene/reader.hpp"
#include "osculate/time/force_balance.hpp"

#include <functional>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace osculate::app::OSCULATE_THIS_FILE {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double pressure = 1e5; ///< on 1 m^2
/// Left over of the forces that act: the last iteration of the solver, whose tolerance is 1e-9.
constexpr double balance = 1e-10;
constexpr double round_off = 1e-12;

/// Two columns one above the other, node on node, pressed together; nu = 0: every force is vertical and goes straight down.
const std::string columns = R"(
bodies:
  base:
    mesh: {block: {size: [1 m, 1 m, 1 m], divisions: [2, 2, 2]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0}}
  cap:
    mesh: {block: {origin: [0, 0, 1 m], size: [1 m, 1 m, 1 m], divisions: [2, 2, 2]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0}}
sets:
  bed: {body: base, surface: z_min}
  ground: {body: base, surface: z_max}
  under: {body: cap, surface: z_min}
  top: {body: cap, surface: z_max}
supports:
  bed: {fix: [x, y, z]}
contact:
  joint: {slave: under, master: {set: ground, surface: facets}, friction: 0.3}
stages:
  press: {pressure: {top: 100 kPa}}
)";

/// A quarter of a block on a quarter of a wider one: master facets beyond the symmetry planes are mirror images.
const std::string quarter = R"(
bodies:
  base:
    mesh: {block: {size: [1 m, 1 m, 0.5 m], divisions: [4, 4, 2]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0.3}}
  cap:
    mesh: {block: {origin: [0, 0, 0.5 m], size: [0.6 m, 0.6 m, 0.5 m], divisions: [3, 3, 2]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0.3}}
sets:
  bed: {body: base, surface: z_min}
  base_x: {body: base, surface: x_min}
  base_y: {body: base, surface: y_min}
  cap_x: {body: cap, surface: x_min}
  cap_y: {body: cap, surface: y_min}
  ground: {body: base, surface: z_max}
  under: {body: cap, surface: z_min}
  top: {body: cap, surface: z_max}
supports:
  bed: {fix: [x, y, z]}
  base_x: {symmetry: [1, 0, 0]}
  base_y: {symmetry: [0, 1, 0]}
  cap_x: {symmetry: [1, 0, 0]}
  cap_y: {symmetry: [0, 1, 0]}
contact:
  joint: {slave: under, master: {set: ground, surface: blend}, friction: 0.5}
stages:
  press: {pressure: {top: 1 MPa}}
)";

/// A bar that swings under gravity, its own damping and a pressure that follows it.
std::string falling(const std::string& integrator, const std::string& material) {
    return R"(
gravity: [0, 0, -10]
bodies:
  bar:
    mesh: {block: {size: [1 m, 0.2 m, 0.1 m], divisions: [4, 1, 1]}}
    material: {)" +
           material + R"(: {E: 1 MPa, nu: 0.3, density: 1000 kg/m^3}}
    initial_velocity: [1 m/s, 0, 0]
    initial_spin: [0, 3, 1]
sets:
  side: {body: bar, surface: x_max}
  end: {body: bar, surface: x_min}
supports:
  end: {fix: [z]}
stages:
  swing:
    analysis: {dynamic: {integrator: )" +
           integrator + R"(, mass_damping: 2, stiffness_damping: 1e-3}}
    duration: 20 ms
    steps: 10
    follower_pressure: {side: 10 kPa}
)";
}

using Look = std::function<void(const time::AcceptedStep&, Plan&)>;

/// Shows every accepted step of a scene.
void run(const std::string& text, const Look& look) {
    struct Observer final : time::StepObserver {
        Observer(const Look& l, Plan& p) : look(l), plan(p) {}
        void attempted(const time::Attempt&, const std::vector<equilibrium::IterationRecord>&) override {}
        void accepted(const time::AcceptedStep& step) override { look(step, plan); }
        const Look& look;
        Plan& plan;
    };
    const scene::Scene scene = scene::parse_scene(text, "scene.yaml");
    Timings timings;
    Plan plan = compile(scene, build_meshes(scene), 1, timings);
    time::Stepper stepper(plan.model, plan.stages, plan.stepper, timings);
    Observer observer(look, plan);
    stepper.run(observer);
}

TEST(ForceBalance, KnowsTheForcesThatAct) {
    run(columns, [](const time::AcceptedStep& step, Plan& plan) {
        const time::ForceBalance forces = time::force_balance(plan.model, step.equilibrium, step.state);
        // load, both sides of the contact, reactions
        EXPECT_NEAR(forces.acting, 4 * pressure, 1e-6 * pressure);
        EXPECT_LT(forces.left_over, balance * pressure);
    });
}

TEST(ForceBalance, ClosesOverFacesWithMidsideNodes) {
    for (const char* element : {"tet10", "hex20"}) {
        std::string text = columns;
        const std::string plain = "divisions: [2, 2, 2]}";
        for (std::size_t at = text.find(plain); at != std::string::npos; at = text.find(plain, at + 1))
            text.replace(at, plain.size(), std::string("divisions: [2, 2, 2], element: ") + element + "}");
        run(text, [](const time::AcceptedStep& step, Plan& plan) {
            EXPECT_FALSE(plan.model.skin.empty());
            const time::ForceBalance forces = time::force_balance(plan.model, step.equilibrium, step.state);
            EXPECT_LT(forces.left_over, balance * pressure);
        });
    }
}

TEST(ForceBalance, SeesAContactForceThatWasTamperedWith) {
    run(columns, [](const time::AcceptedStep& step, Plan& plan) {
        model::State tampered = step.state;
        const Vec3 more(3, 0, 4); // N
        tampered.contact[0].lambda[4] += more;
        const time::ForceBalance forces = time::force_balance(plan.model, step.equilibrium, tampered);
        EXPECT_NEAR(forces.left_over, more.norm(), 1e-6);

        RunChecks checks(plan.model, scene::Expectation{});
        checks.accepted({tampered, step.equilibrium, step.dt, step.iterations, step.stage, step.ledger});
        const double expected = more.norm() / (4 * pressure);
        EXPECT_NEAR(checks.checks().force_balance, expected, 1e-3 * expected);
        EXPECT_THAT(checks.judge("")->misses, ElementsAre("force balance 1.25e-05 above 1e-06"));
    });
}

TEST(ForceBalance, ClosesWithMirroredMasters) {
    run(quarter, [](const time::AcceptedStep& step, Plan& plan) {
        ASSERT_TRUE(plan.model.pairs[0]->mirrored());
        const time::ForceBalance forces = time::force_balance(plan.model, step.equilibrium, step.state);
        EXPECT_LT(forces.left_over, balance * forces.acting);
    });
}

TEST(ForceBalance, ClosesInMotionWithEveryIntegratorAndMaterial) {
    for (const char* material : {"linear_elastic", "neo_hookean"})
        for (const char* integrator : {"{generalised_alpha: {rho_inf: 0.5}}", "newmark", "{hht: {}}", "backward_euler"})
            run(falling(integrator, material), [&](const time::AcceptedStep& step, Plan& plan) {
                const time::ForceBalance forces = time::force_balance(plan.model, step.equilibrium, step.state);
                EXPECT_GT(forces.acting, 20 * 10) << "20 kg";
                EXPECT_LT(forces.left_over, 10 * balance * forces.acting) << material << ", " << integrator;
            });
}

TEST(RunChecks, MeasurePenetrationInFacetSizes) {
    run(columns, [](const time::AcceptedStep& step, Plan& plan) {
        const std::optional<scene::Expectation> expect{std::in_place};
        RunChecks checks(plan.model, expect);
        checks.accepted(step);
        EXPECT_LT(checks.checks().penetration, round_off);
        EXPECT_THAT(checks.judge("")->misses, IsEmpty());

        // the same equilibrium, but that contact is looked at where the cap has sunk
        Timings unused;
        equilibrium::Equilibrium sunk(
            plan.model, plan.model.pairs, step.equilibrium.constraints(), nullptr,
            equilibrium::choose_tangent(plan.model, plan.model.pairs, LinearSolver::automatic, false, false), unused,
            1);
        sunk.begin_attempt(step.state, {step.equilibrium.external_force(), step.state.u}, step.dt);
        const Vector z = sunk.unknowns(step.state.u, step.state.contact);
        ASSERT_TRUE(sunk.holds(z, step.equilibrium.statuses(), balance));
        constexpr double depth = 0.01, size = 0.5; // m
        std::vector<Vec3> x = plan.model.X;
        for (std::size_t i = 0; i < x.size(); ++i) {
            x[i] += step.state.u[i];
            if (static_cast<Index>(i) >= plan.model.bodies[1].first_node) x[i].z() -= depth;
        }
        sunk.contact()[0].evaluate(x, unused, 1);
        checks.accepted({step.state, sunk, step.dt, step.iterations, step.stage, nullptr});
        EXPECT_NEAR(checks.checks().penetration_m, depth, round_off);
        EXPECT_NEAR(checks.checks().penetration, depth / size, round_off);
        EXPECT_THAT(checks.judge("")->misses, ElementsAre("penetration 0.02 above 1e-06 facet sizes"));

        time::Stage stage = step.stage; // where it has a bound of its own, that holds
        for (const auto& [bound, metres, misses] : {std::tuple{0.021, false, 0U}, std::tuple{0.019, false, 1U},
                                                    std::tuple{0.0101, true, 0U}, std::tuple{0.0099, true, 1U}}) {
            stage.limits.allowed_interpenetration = bound;
            stage.limits.usual_bound = false;
            stage.limits.in_metres = metres;
            RunChecks bounded(plan.model, expect);
            bounded.accepted({step.state, sunk, step.dt, step.iterations, stage, nullptr});
            EXPECT_EQ(bounded.judge("")->misses.size(), misses) << bound;
        }
    });
}

TEST(RunChecks, MeasureEnergiesAgainstTheLargest) {
    run(columns, [](const time::AcceptedStep& step, Plan& plan) {
        std::optional<scene::Expectation> expect{std::in_place};
        expect->energy_growth = 0.01;
        RunChecks checks(plan.model, expect);
        EXPECT_FALSE(checks.checks().energy_growth);
        time::Ledger ledger; // of a start with 7 J
        ledger.kinetic = 10;
        ledger.strain = 2;
        ledger.external = 4.8;
        ledger.contact = 0.3;
        ledger.friction = 0.05;
        ledger.algorithmic = 0.04;
        ledger.balance = -0.01;
        checks.accepted({step.state, step.equilibrium, step.dt, step.iterations, step.stage, &ledger});
        EXPECT_NEAR(*checks.checks().energy_growth, 0.2 / 12, round_off);
        EXPECT_NEAR(*checks.checks().energy_balance, 0.01 / 12, round_off);
        EXPECT_THAT(checks.judge("")->misses, ElementsAre("energy growth 0.0167 above 0.01"));
        EXPECT_EQ(*checks.checks().closing_loss, 0);
        EXPECT_THAT(checks.warnings(), IsEmpty());
        ledger.contact = -11; // later all is lost; what was gained before is not forgotten
        ledger.kinetic = 0.7;
        ledger.strain = 0;
        checks.accepted({step.state, step.equilibrium, step.dt, step.iterations, step.stage, &ledger});
        EXPECT_NEAR(*checks.checks().energy_growth, 0.2 / 12, round_off);
        EXPECT_NEAR(*checks.checks().closing_loss, 11.3 / 12, round_off);
        EXPECT_THAT(checks.warnings(), ElementsAre(HasSubstr("gaps that closed took 0.94")));
        RunChecks resumed(plan.model, expect);
        resumed.recall(checks.memory());
        EXPECT_EQ(resumed.warnings(), checks.warnings());
        ledger.contact = -5; // what a release brings in does not make up for it
        resumed.accepted({step.state, step.equilibrium, step.dt, step.iterations, step.stage, &ledger});
        EXPECT_NEAR(*resumed.checks().closing_loss, 11.3 / 12, round_off);
    });
}

TEST(RunChecks, WarnOfInelasticImpactsThatARuleChose) {
    run(columns, [](const time::AcceptedStep& step, Plan& plan) {
        time::Stage inelastic = step.stage, resolved = step.stage;
        inelastic.limits.inelastic_impacts = true;
        const auto with = [&](const time::Ledger& ledger, const time::Stage& stage) {
            return time::AcceptedStep{step.state, step.equilibrium, step.dt, step.iterations, stage, &ledger};
        };
        time::Ledger fallen, landed; // 10 J, of which an impact takes 9, friction the rest
        fallen.kinetic = 10;
        landed.damping = landed.settling = 9;
        landed.friction = 1;
        RunChecks by_rule(plan.model, {}, true), told(plan.model, {}, false), follows(plan.model, {}, true);
        for (const time::Ledger* ledger : {&fallen, &landed}) {
            by_rule.accepted(with(*ledger, inelastic));
            told.accepted(with(*ledger, inelastic));
            follows.accepted(with(*ledger, resolved)); // damping that the scene asks for
        }
        EXPECT_NEAR(by_rule.checks().settling_loss.value(), 0.9, round_off);
        EXPECT_THAT(by_rule.warnings(), ElementsAre(HasSubstr("took 0.9 of the largest energy")));
        EXPECT_FALSE(told.checks().settling_loss);
        EXPECT_THAT(told.warnings(), IsEmpty());
        EXPECT_EQ(follows.checks().settling_loss.value(), 0);
        EXPECT_THAT(follows.warnings(), IsEmpty());
        RunChecks resumed(plan.model, {}, false); // the scene of a run's folder says `inelastic`
        resumed.recall(by_rule.memory());
        EXPECT_EQ(resumed.warnings(), by_rule.warnings());
        landed.settling = 9.5;
        resumed.accepted(with(landed, inelastic));
        EXPECT_NEAR(resumed.checks().settling_loss.value(), 0.95, round_off);
    });
}

TEST(RunChecks, JudgeHowARunEnded) {
    const model::Model none;
    const auto misses = [&](const scene::Expectation& expect, const std::string& failure) {
        return RunChecks(none, expect).judge(failure)->misses;
    };
    EXPECT_FALSE(RunChecks(none, std::nullopt).judge(""));
    scene::Expectation expect;
    EXPECT_THAT(misses(expect, ""), IsEmpty());
    EXPECT_THAT(misses(expect, "held by nothing"), ElementsAre("gave up but should complete"));
    expect.outcome = scene::Outcome::gives_up;
    EXPECT_THAT(misses(expect, "a body is held by nothing"), IsEmpty());
    EXPECT_THAT(misses(expect, ""), ElementsAre("completed but should give up"));
    expect.cause = "held by nothing";
    EXPECT_THAT(misses(expect, "a body is held by nothing"), IsEmpty());
    EXPECT_THAT(misses(expect, "no convergence"), ElementsAre(HasSubstr("without the words 'held by nothing'")));
}

} // namespace
} // namespace osculate::app::OSCULATE_THIS_FILE
