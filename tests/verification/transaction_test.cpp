/// A rejected attempt leaves no trace: not in the bits of what is accepted afterwards.

#include "support/scene_runner.hpp"

#include <algorithm>
#include <gtest/gtest.h>

namespace osculate {
namespace {

struct Diary final : time::StepObserver {
    std::vector<time::Attempt> attempts;
    std::vector<model::State> states;
    std::vector<time::Ledger> ledgers; ///< of dynamic steps
    void attempted(const time::Attempt& attempt, const std::vector<time::IterationRecord>&) override {
        attempts.push_back(attempt);
    }
    void accepted(const time::AcceptedStep& step) override {
        states.push_back(step.state);
        if (step.ledger != nullptr) ledgers.push_back(*step.ledger);
    }
    [[nodiscard]] int count(time::Reason reason) const {
        return static_cast<int>(std::count_if(attempts.begin(), attempts.end(), [&](const time::Attempt& a) {
            return a.verdict == time::Verdict::retry && a.reason == reason;
        }));
    }
};

Diary run(const std::string& scene_name, const std::vector<scene::Override>& overrides, int reject_every,
          int threads = 1) {
    const scene::Scene scene = scene::read_scene(support::shipped(scene_name), overrides);
    Timings timings;
    app::Plan plan = app::compile(scene, app::build_meshes(scene), threads, timings);
    plan.stepper.reject_every = reject_every;
    Diary diary;
    time::Stepper stepper(plan.model, plan.stages, plan.stepper, timings);
    stepper.run(diary);
    return diary;
}

void expect_same_bits(const Diary& a, const Diary& b) {
    ASSERT_EQ(a.states.size(), b.states.size());
    for (std::size_t k = 0; k < a.states.size(); ++k) {
        const model::State &x = a.states[k], &y = b.states[k];
        ASSERT_EQ(x.time, y.time);
        ASSERT_EQ(x.u, y.u) << "step " << k;
        ASSERT_EQ(x.v, y.v) << "step " << k;
        ASSERT_EQ(x.a, y.a) << "step " << k;
        for (std::size_t p = 0; p < x.contact.size(); ++p) {
            ASSERT_EQ(x.contact[p].lambda, y.contact[p].lambda) << "step " << k;
            ASSERT_EQ(x.contact[p].status, y.contact[p].status) << "step " << k;
            ASSERT_EQ(x.contact[p].facet, y.contact[p].facet) << "step " << k;
        }
    }
    ASSERT_EQ(a.ledgers.size(), b.ledgers.size());
    for (std::size_t k = 0; k < a.ledgers.size(); ++k) {
        const time::Ledger &x = a.ledgers[k], &y = b.ledgers[k];
        ASSERT_EQ(x.kinetic + x.strain, y.kinetic + y.strain) << "step " << k;
        ASSERT_EQ(x.friction, y.friction) << "step " << k;
        ASSERT_EQ(x.contact, y.contact) << "step " << k;
        ASSERT_EQ(x.angular, y.angular) << "step " << k;
    }
}

const std::vector<scene::Override> impact{{"stages.bounce.duration", "1.1"},
                                          {"stages.bounce.steps", "215"},
                                          {"stages.bounce.control.allowed_interpenetration", "1e-3"}};
/// Stick and slip on a smooth master, facets left and entered: half a metre along the half-tube.
const std::vector<scene::Override> slide{{"bodies.tube.mesh.half_tube.divisions", "[7, 6, 1]"},
                                         {"bodies.contactor.mesh.contactor.divisions", "[5, 6, 1]"},
                                         {"stages.slide.steps", "7"},
                                         {"stages.slide.duration", "7"},
                                         {"stages.slide.displacement.rear.y", "0.5"}};

/// Dynamics with all of it: a tilted block thrown on a smooth master sticks and slips, corner after corner.
const std::vector<scene::Override> thrown{{"bodies.block.mesh.rotate", "{axis: [1, 2, 0], angle: 0.02}"},
                                          {"bodies.block.mesh.translate", "[0, 0, -0.45]"},
                                          {"bodies.block.initial_velocity", "[0.05, 0.02, 0]"},
                                          {"contact.floor.surface", "blend"},
                                          {"contact.floor.friction", "0.8"},
                                          {"stages.fall.analysis.dynamic.contact_mass", "redistributed"},
                                          {"stages.fall.duration", "0.13"},
                                          {"stages.fall.steps", "65"}};

TEST(Transaction, RejectedAttemptsOfAThrowWithFrictionLeaveNoTrace) {
    const Diary straight = run("validation/falling_block.yaml", thrown, 0);
    EXPECT_GT(straight.count(time::Reason::interpenetration), 3);
    int stick = 0, slip = 0;
    for (const model::State& state : straight.states) {
        stick += static_cast<int>(std::ranges::count(state.contact[0].status, contact::Status::stick));
        slip += static_cast<int>(std::ranges::count(state.contact[0].status, contact::Status::slip));
    }
    EXPECT_GT(stick, 3);
    EXPECT_GT(slip, 3);
    for (const int every : {2, 3, 7}) {
        const Diary rejected = run("validation/falling_block.yaml", thrown, every);
        EXPECT_GT(rejected.count(time::Reason::forced), 5);
        expect_same_bits(straight, rejected);
    }
    for (const int threads : {2, 3})
        expect_same_bits(straight, run("validation/falling_block.yaml", thrown, 0, threads));
}

TEST(Transaction, RejectedAttemptsOfAnImpactLeaveNoTrace) {
    const Diary straight = run("validation/bouncing_rod.yaml", impact, 0);
    EXPECT_GT(straight.count(time::Reason::interpenetration), 0) << "nothing was cut";
    EXPECT_EQ(straight.count(time::Reason::forced), 0);
    for (const int every : {2, 3, 7}) {
        const Diary rejected = run("validation/bouncing_rod.yaml", impact, every);
        EXPECT_GT(rejected.count(time::Reason::forced), 20);
        expect_same_bits(straight, rejected);
    }
}

TEST(Transaction, RejectedAttemptsOfASlideLeaveNoTrace) {
    const Diary straight = run("paper/half_tube.yaml", slide, 0);
    for (const int every : {2, 3, 7}) {
        const Diary rejected = run("paper/half_tube.yaml", slide, every);
        EXPECT_GT(rejected.count(time::Reason::forced), 0);
        expect_same_bits(straight, rejected);
    }
}

TEST(Transaction, RejectedAttemptsWithMortarLeaveNoTrace) {
    auto mortar = slide;
    mortar.push_back({"contact.sliding.discretisation", "mortar"});
    const Diary straight = run("paper/half_tube.yaml", mortar, 0);
    for (const int every : {2, 3}) expect_same_bits(straight, run("paper/half_tube.yaml", mortar, every));
    expect_same_bits(straight, run("paper/half_tube.yaml", mortar, 0, 3));
}

TEST(Transaction, RejectedAttemptsAtFiniteStrainLeaveNoTrace) {
    std::vector<scene::Override> rubber = thrown;
    rubber.push_back({"bodies.block.material", "{neo_hookean: {E: 1 MPa, nu: 0.3, density: 1000 kg/m^3}}"});
    rubber.push_back({"stages.fall.analysis.dynamic.stiffness_damping", "0.1 ms"});
    rubber.push_back({"stages.fall.follower_pressure", "{underside: 100 Pa}"});
    const Diary straight = run("validation/falling_block.yaml", rubber, 0);
    EXPECT_GT(straight.count(time::Reason::interpenetration), 3);
    for (const int every : {2, 7}) {
        const Diary rejected = run("validation/falling_block.yaml", rubber, every);
        EXPECT_GT(rejected.count(time::Reason::forced), 5);
        expect_same_bits(straight, rejected);
    }
    expect_same_bits(straight, run("validation/falling_block.yaml", rubber, 0, 3));
}

TEST(Transaction, ThreadsDoNotChangeABit) {
    expect_same_bits(run("validation/bouncing_rod.yaml", impact, 0, 1),
                     run("validation/bouncing_rod.yaml", impact, 0, 3));
    expect_same_bits(run("paper/half_tube.yaml", slide, 0, 1), run("paper/half_tube.yaml", slide, 0, 3));
}

/// At every accepted step no point that was open before has gone deeper in the trial than allowed: what is accepted after
/// the contact solve is not deeper either.
TEST(StepControl, KeepsOpenPointsAboveTheAllowedInterpenetration) {
    for (const double allowed : {1e-2, 1e-3}) {
        auto overrides = impact;
        overrides.back().value = std::to_string(allowed);
        const Diary diary = run("validation/bouncing_rod.yaml", overrides, 0);
        for (const time::Attempt& a : diary.attempts) {
            if (a.verdict != time::Verdict::retry) continue;
            EXPECT_EQ(a.reason, time::Reason::interpenetration);
            EXPECT_LT(a.value, -allowed * 0.1) << "cut for less than facets of 0.1 m allow";
            EXPECT_EQ(a.body, "rod");
            EXPECT_GE(a.node, 0);
        }
        const double time_of_contact = 2, step = 1.1 / 215;
        for (const model::State& state : diary.states)
            EXPECT_TRUE(state.time > time_of_contact - step || state.contact[0].lambda[0].isZero(0));
        // tip of the rod against the plane x = 0
        for (const model::State& state : diary.states)
            for (Index i = 0; i < 4; ++i) EXPECT_GT(state.u[static_cast<std::size_t>(i) * 101].x(), -allowed * 0.1);
    }
}

} // namespace
} // namespace osculate
