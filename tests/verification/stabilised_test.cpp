/// The rung `stabilised`: bodies that nothing holds yet come to rest on what stops them, and what is accepted is an
/// equilibrium without anything to lean on.

#include "osculate/core/error.hpp"
#include "osculate/time/post_mortem.hpp"
#include "support/scene_file.hpp"
#include "support/scene_runner.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

/// A block above a rigid slab, without support and without friction, under its weight of 2000 N. (On one that gives way
/// the block would slide, along the bowl it makes, to where that is level.)
const char* const falling = R"(
bodies:
  slab:
    mesh: {block: {origin: [-0.5 m, -0.5 m, -0.25 m], size: [1 m, 1 m, 0.25 m], divisions: [5, 5, 1]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0.3}}
  block:
    mesh: {block: {origin: [-0.23 m, -0.27 m, 0 m], size: [0.5 m, 0.5 m, 0.5 m], divisions: [3, 3, 3]}}
    material: {linear_elastic: {E: 10 MPa, nu: 0.3}}
sets:
  sole: {body: block, surface: z_min}
  ground: {body: slab, surface: z_max}
  bed: {body: slab, box: {min: [-1 m, -1 m, -1 m], max: [1 m, 1 m, 1 m]}}
supports:
  bed: {fix: [x, y, z]}
contact:
  joint: {slave: sole, master: {set: ground, surface: facets}}
stages:
  rest: {body_force: {block: [0 N/m^3, 0 N/m^3, -16 kN/m^3]}}
)";
constexpr double weight = 2000, size = 0.5; // N, m

struct Outcome final : time::StepObserver {
    app::Plan plan;
    Timings timings;
    std::vector<model::State> states; ///< accepted
    std::vector<time::Attempt> attempts;
    double left_over = 0;      ///< largest force out of balance at an accepted state, of the tolerance
    bool springs = false;      ///< were in place at one
    int stabilised = 0;        ///< accepted steps
    std::string failure;       ///< of the run
    time::PostMortem examined; ///< then

    explicit Outcome(const std::string& text, const std::vector<scene::Override>& changes = {}, int reject_every = 0,
                     int threads = 1) {
        const scene::Scene scene = scene::read_scene(support::scene_file("stabilised.yaml", text), changes);
        plan = app::compile(scene, app::build_meshes(scene), threads, timings);
        plan.stepper.reject_every = reject_every;
        time::Stepper stepper(plan.model, plan.stages, plan.stepper, timings);
        try {
            stepper.run(*this);
        } catch (const RunFailure& caught) {
            failure = caught.what();
        }
        stabilised = stepper.counts().stabilised_steps;
    }
    void attempted(const time::Attempt& attempt, const std::vector<equilibrium::IterationRecord>&) override {
        attempts.push_back(attempt);
    }
    /// Equilibrium from internal forces, loads and contact forces alone, apart from what the solver made it of.
    void accepted(const time::AcceptedStep& step) override {
        const model::Model& model = plan.model;
        Field f = model::internal_force(model, step.state.at_rest(), 1);
        for (std::size_t i = 0; i < f.size(); ++i) f[i] -= step.equilibrium.external_force()[i];
        for (std::size_t p = 0; p < model.pairs.size(); ++p) {
            const model::ContactEvaluation& evaluation = step.equilibrium.contact()[p];
            const model::ContactPair& pair = evaluation.pair();
            for (Index j = 0; j < pair.size(); ++j) {
                const Vec3& lambda = step.state.contact[p].lambda[j];
                f[pair.slaves().node[j]] -= lambda;
                for (Index i = 0; evaluation.point(j).found && i < evaluation.carriers(j); ++i)
                    f[evaluation.point_nodes(j)[i]] -= evaluation.master_force(j, i, lambda);
            }
        }
        const double allowed = plan.stepper.tolerance * step.equilibrium.reference_force();
        for (Index i = 0; i < model.nodes(); ++i) {
            const Vec3 rest = f[i] - step.equilibrium.constraints().reaction(i, f[i]);
            left_over = std::max(left_over, rest.cwiseAbs().maxCoeff() / allowed);
        }
        springs = springs || step.equilibrium.bodies().stabilised();
        states.push_back(step.state);
    }
    void gave_up(const time::PostMortem& post_mortem, const time::FailedIterate*) override { examined = post_mortem; }

    [[nodiscard]] Vec3 contact_force(std::size_t pair = 0) const {
        Vec3 sum = Vec3::Zero();
        for (const Vec3& lambda : states.back().contact[pair].lambda) sum += lambda;
        return sum;
    }
    [[nodiscard]] Vec3 mean_displacement(const std::string& name) const {
        const model::Body& body = *std::ranges::find(plan.model.bodies, name, &model::Body::name);
        Vec3 sum = Vec3::Zero();
        for (Index i = 0; i < body.nodes(); ++i) sum += states.back().u[body.first_node + i];
        return sum / static_cast<double>(body.nodes());
    }
};

std::vector<scene::Override> above(double gap) {
    return {{"bodies.block.mesh.translate", "[0, 0, " + std::to_string(gap) + "]"}};
}

/// Forces are exact to the tolerance, 1e-9 of a reference of their size, at each of some hundred nodes.
constexpr double same_force = 1e-7;
/// Springs give way by the round-off of the forces over their stiffness: 1e-11 was measured.
constexpr double same_place = 1e-8;

TEST(Stabilised, ABodyOverAGapComesToRestOnItsSupportAsOneThatTouchedItFromTheStart) {
    // the same without any gap, held by no more than it takes
    std::string touching = falling;
    touching.replace(touching.find("sets:\n"), 6,
                     "sets:\n  corner: {body: block, box: {min: [-0.24 m, -0.28 m, 0.49 m], max: [-0.22 m, -0.26 m, "
                     "0.51 m]}}\n  other: {body: block, box: {min: [0.26 m, -0.28 m, 0.49 m], max: [0.28 m, -0.26 m, "
                     "0.51 m]}}\n");
    touching.replace(touching.find("supports:\n"), 10, "supports:\n  corner: {fix: [x, y]}\n  other: {fix: [y]}\n");
    const Outcome reference(touching);
    ASSERT_EQ(reference.failure, "");
    EXPECT_EQ(reference.stabilised, 0);
    for (const double gap : {0.001, 0.05, 0.3}) {
        const Outcome fallen(falling, above(gap));
        ASSERT_EQ(fallen.failure, "");
        EXPECT_EQ(fallen.stabilised, 1) << "gap " << gap;
        EXPECT_LE(fallen.left_over, 1) << "gap " << gap;
        EXPECT_FALSE(fallen.springs);
        EXPECT_NEAR(fallen.contact_force().z(), weight, same_force * weight);
        double worst = 0;
        for (std::size_t j = 0; j < fallen.states[0].contact[0].lambda.size(); ++j)
            worst = std::max(worst,
                             (fallen.states[0].contact[0].lambda[j] - reference.states[0].contact[0].lambda[j]).norm());
        std::printf("gap %g: forces differ by %.2e of the weight, %d iterations, lateral %.2e m\n", gap, worst / weight,
                    fallen.attempts[0].iterations, fallen.mean_displacement("block").head<2>().norm());
        EXPECT_LT(worst, same_force * weight);
        EXPECT_NEAR(fallen.mean_displacement("block").z() + gap, reference.mean_displacement("block").z(),
                    same_place * size);
    }
}

TEST(Stabilised, MotionsThatNothingDeterminesStayPut) {
    // no friction: along x and y and about z the block may be anywhere
    for (const double gap : {0.0, 0.05}) {
        const Outcome fallen(falling, above(gap));
        ASSERT_EQ(fallen.failure, "");
        const Vec3 moved = fallen.mean_displacement("block");
        std::printf("gap %g: lateral %.2e m, down %.2e m\n", gap, moved.head<2>().norm(), moved.z());
        EXPECT_LT(moved.head<2>().norm(), same_place * size);
    }
}

TEST(Stabilised, OnGroundThatGivesWayABodySlidesToWhereItIsLevel) {
    auto changes = above(0.05);
    changes.push_back({"sets.bed", "{body: slab, surface: z_min}"});
    const Outcome fallen(falling, changes);
    ASSERT_EQ(fallen.failure, "");
    EXPECT_LE(fallen.left_over, 1);
    EXPECT_NEAR(fallen.contact_force().z(), weight, same_force * weight);
    EXPECT_LT(fallen.contact_force().head<2>().norm(), same_force * weight);
}

TEST(Stabilised, WithoutTheRungARunGivesUpNamingTheBody) {
    auto changes = above(0.05);
    changes.push_back({"solver.stabilisation", "false"});
    const Outcome outcome(falling, changes);
    EXPECT_NE(outcome.failure.find("'block'"), std::string::npos) << outcome.failure;
    EXPECT_EQ(outcome.examined.cause, time::Cause::unsupported_body);
    EXPECT_EQ(outcome.examined.body, "block");
    EXPECT_GT(outcome.attempts.size(), 1u) << "smaller steps were not tried";
}

TEST(Stabilised, ABodyThatNothingCatchesIsGivenUpAtOnce) {
    auto changes = above(0.05);
    changes.push_back({"stages.rest.body_force.block", "[0, 0, 16 kN/m^3]"});
    const Outcome outcome(falling, changes);
    EXPECT_NE(outcome.failure.find("body 'block' is held by nothing"), std::string::npos) << outcome.failure;
    EXPECT_EQ(outcome.examined.cause, time::Cause::unsupported_body);
    EXPECT_EQ(outcome.examined.body, "block");
    EXPECT_EQ(outcome.attempts.size(), 1u) << "smaller steps are of no use";
}

TEST(Stabilised, BodiesInARowCloseTheGapsBetweenThem) {
    std::string row = falling;
    row.replace(row.find("sets:\n"), 6, R"(  hat:
    mesh: {block: {origin: [-0.2 m, -0.2 m, 0.58 m], size: [0.4 m, 0.4 m, 0.2 m], divisions: [2, 2, 1]}}
    material: {linear_elastic: {E: 1 MPa, nu: 0.3}}
sets:
  brim: {body: hat, surface: z_min}
  crown: {body: block, surface: z_max}
)");
    row.replace(row.find("stages:\n"), 8, "  lid: {slave: brim, master: {set: crown, surface: facets}}\nstages:\n");
    auto changes = above(0.03);
    changes.push_back({"stages.rest.body_force.hat", "[0, 0, -25 kN/m^3]"});
    const double of_hat = 25e3 * 0.4 * 0.4 * 0.2;
    const Outcome outcome(row, changes);
    ASSERT_EQ(outcome.failure, "");
    EXPECT_EQ(outcome.stabilised, 1);
    EXPECT_LE(outcome.left_over, 1);
    EXPECT_NEAR(outcome.contact_force(0).z(), weight + of_hat, same_force * weight);
    EXPECT_NEAR(outcome.contact_force(1).z(), of_hat, same_force * weight);
}

/// The tangent is not singular to the last digit, and its solution 500 km below the slab.
TEST(Stabilised, ABodyOnAThreadOfNextToNoStiffnessLandsUnderItsLoad) {
    const Outcome outcome(R"(
bodies:
  slab:
    mesh: {block: {size: [20 mm, 20 mm, 10 mm], divisions: [4, 4, 2]}}
    material: {linear_elastic: {E: 70 GPa, nu: 0.33}}
  block:
    mesh: {block: {origin: [5 mm, 5 mm, 13 mm], size: [10 mm, 10 mm, 20 mm], divisions: [3, 3, 4]}}
    material: {linear_elastic: {E: 210 GPa, nu: 0.3}}
    sections:
      thread: {box: {min: [0 mm, 0 mm, 23 mm], max: [1 m, 1 m, 1 m]}, material: {linear_elastic: {E: 0.01 Pa, nu: 0}}}
sets:
  bed: {body: slab, surface: z_min}
  ground: {body: slab, surface: z_max}
  hook: {body: block, surface: z_max}
  sole: {body: block, surface: z_min}
  guided: {body: block, box: {min: [0 mm, 0 mm, 14 mm], max: [1 m, 1 m, 22 mm]}}
supports:
  bed: {fix: [x, y, z]}
  hook: {fix: [x, y, z]}
  guided: {fix: [x, y]}
contact:
  joint: {slave: sole, master: {set: ground}, friction: 0.15}
stages:
  press: {steps: 2, pressure: {sole: -1 MPa}}
)");
    ASSERT_EQ(outcome.failure, "");
    EXPECT_EQ(outcome.attempts.size(), 2u);
    EXPECT_EQ(outcome.stabilised, 1);
    EXPECT_LE(outcome.left_over, 1);
    EXPECT_NEAR(outcome.contact_force(0).z(), 100, same_force * 100); // 1 MPa on a square of 10 mm
}

TEST(Stabilised, RejectedAttemptsAndThreadsLeaveNoTrace) {
    auto changes = above(0.05);
    changes.push_back({"stages.rest.steps", "3"});
    const Outcome straight(falling, changes);
    ASSERT_EQ(straight.failure, "");
    ASSERT_GT(straight.stabilised, 0);
    for (const auto& [every, threads] : {std::pair{2, 1}, std::pair{3, 1}, std::pair{0, 2}}) {
        const Outcome other(falling, changes, every, threads);
        ASSERT_EQ(other.failure, "");
        EXPECT_EQ(other.attempts.size() > straight.attempts.size(), every > 0);
        ASSERT_EQ(straight.states.size(), other.states.size());
        for (std::size_t k = 0; k < straight.states.size(); ++k) {
            EXPECT_EQ(straight.states[k].u, other.states[k].u) << "step " << k << ", every " << every;
            EXPECT_EQ(straight.states[k].contact[0].lambda, other.states[k].contact[0].lambda) << "step " << k;
            EXPECT_EQ(straight.states[k].contact[0].status, other.states[k].contact[0].status) << "step " << k;
        }
    }
}

/// Newton's method that may take its time leaps from one side to the other. Springs let go of an arch whose tangent is negative only while
/// they are stiffer than that, by an amount that changes on the way; both come to rest in one place where there is no friction.
TEST(Stabilised, AnArchThatSnapsThroughComesToRestWhereNewtonsMethodFindsIt) {
    const std::vector<scene::Override> both = {{"contact.catch.friction", "0"},
                                               {"stages.load.pressure.upper", "6 kPa"}, // it snaps at 4.6 kPa
                                               {"stages.load.steps", "2"}};
    support::SceneRun leaps, sprung;
    support::run_scene(leaps, support::shipped("extreme/snap_through.yaml"), both);
    std::vector<scene::Override> impatient = both;
    impatient.insert(impatient.end(), {{"solver.max_iterations", "6"}, {"solver.smallest_step", "0.1"}});
    support::run_scene(sprung, support::shipped("extreme/snap_through.yaml"), impatient);
    const support::RunStep &one = leaps.steps.back(), &other = sprung.steps.back();
    // the rungs before that of springs may take some 60, see settle()
    EXPECT_TRUE(std::ranges::any_of(sprung.steps, [](const support::RunStep& step) { return step.iterations > 100; }));
    double apart = 0, moved = 0; // m
    for (std::size_t i = 0; i < one.state.u.size(); ++i) {
        apart = std::max(apart, (one.state.u[i] - other.state.u[i]).norm());
        moved = std::max(moved, one.state.u[i].norm());
    }
    EXPECT_GT(moved, 0.1); // through the line between the ends
    EXPECT_LT(apart, same_place) << "m";
    ASSERT_GT(one.pairs[0].normal, 100); // N
    EXPECT_NEAR(one.pairs[0].normal, other.pairs[0].normal, same_force * one.pairs[0].normal);
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
