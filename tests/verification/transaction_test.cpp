/// A rejected attempt leaves no trace: not in the bits of what is accepted afterwards.

#include "support/diary.hpp"
#include "support/floating_point_traps.hpp"
#include "support/scene_runner.hpp"

#include <gtest/gtest.h>
#include <optional>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

using support::Diary, support::expect_same_bits, support::impact, support::slide, support::thrown;

Diary run(const std::string& scene_name, const std::vector<scene::Override>& overrides, int reject_every,
          int threads = 1) {
    app::Plan plan = support::compiled(scene::read_scene(support::shipped(scene_name), overrides), threads);
    return support::diary_of(plan, reject_every);
}

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
    for (const auto& [every, threads] : {std::pair{2, 1}, {3, 2}, {7, 3}}) {
        const Diary rejected = run("validation/falling_block.yaml", thrown, every, threads);
        EXPECT_GT(rejected.count(time::Reason::forced), 5);
        expect_same_bits(straight, rejected);
    }
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

TEST(Transaction, RejectedAttemptsWithAveragesOverFacetsLeaveNoTrace) {
    for (const char* discretisation : {"mortar", "petrov_galerkin"}) {
        SCOPED_TRACE(discretisation);
        auto averaged = slide;
        averaged.push_back({"contact.sliding.discretisation", discretisation});
        const Diary straight = run("paper/half_tube.yaml", averaged, 0);
        expect_same_bits(straight, run("paper/half_tube.yaml", averaged, 2));
        expect_same_bits(straight, run("paper/half_tube.yaml", averaged, 3, 3)); // by three threads
    }
}

TEST(Transaction, RejectedAttemptsAtFiniteStrainLeaveNoTrace) {
    std::vector<scene::Override> rubber = thrown;
    rubber.push_back({"bodies.block.material", "{neo_hookean: {E: 1 MPa, nu: 0.3, density: 1000 kg/m^3}}"});
    rubber.push_back({"stages.fall.analysis.dynamic.stiffness_damping", "0.1 ms"});
    rubber.push_back({"stages.fall.follower_pressure", "{underside: 100 Pa}"});
    const Diary straight = run("validation/falling_block.yaml", rubber, 0);
    EXPECT_GT(straight.count(time::Reason::interpenetration), 3);
    for (const auto& [every, threads] : {std::pair{2, 1}, {7, 3}}) {
        const Diary rejected = run("validation/falling_block.yaml", rubber, every, threads);
        EXPECT_GT(rejected.count(time::Reason::forced), 5);
        expect_same_bits(straight, rejected);
    }
}

TEST(Transaction, RejectedAttemptsByMultigridLeaveNoTrace) {
    const support::FloatingPointTraps suspended(false); // PETSc's eigenvalue estimates
    std::vector<scene::Override> rubber = thrown, sliding = slide;
    rubber.push_back({"bodies.block.material", "{neo_hookean: {E: 1 MPa, nu: 0.3, density: 1000 kg/m^3}}"});
    for (auto* overrides : {&rubber, &sliding}) overrides->push_back({"solver.linear_solver", "multigrid"});
    for (const auto& [scene, overrides] :
         {std::pair{"validation/falling_block.yaml", rubber}, {"paper/half_tube.yaml", sliding}}) {
        const Diary straight = run(scene, overrides, 0);
        for (const int every : {2, 3}) {
            const Diary rejected = run(scene, overrides, every);
            EXPECT_GT(rejected.count(time::Reason::forced), 0);
            expect_same_bits(straight, rejected);
        }
    }
}

TEST(Transaction, RejectedAttemptsByAnySolverLeaveNoTrace) {
    for (const char* solver : {"condensed", "iterative", "direct"}) {
        SCOPED_TRACE(solver);
        auto overrides = slide;
        overrides.push_back({"solver.linear_solver", solver});
        const Diary straight = run("paper/half_tube.yaml", overrides, 0);
        const Diary rejected = run("paper/half_tube.yaml", overrides, 2);
        EXPECT_GT(rejected.count(time::Reason::forced), 0);
        expect_same_bits(straight, rejected);
    }
}

/// Keeps what steps started from of which an attempt was cut after statuses had changed in it, and what they came to.
struct Cuts final : time::StepObserver {
    std::vector<time::Checkpoint> before; ///< with the length that the step had in the end
    std::vector<model::State> after;
    void attempted(const time::Attempt& attempt, const std::vector<equilibrium::IterationRecord>& iterations) override {
        if (attempt.verdict != time::Verdict::retry) return;
        for (const equilibrium::IterationRecord& one : iterations) changed = changed || one.status_changes > 0;
    }
    void accepted(const time::AcceptedStep& step) override {
        if (changed && last) {
            before.push_back(*last);
            before.back().dt = step.dt;
            after.push_back(step.state);
        }
        changed = false;
    }
    void between_steps(const std::function<time::Checkpoint()>& checkpoint) override { last = checkpoint(); }

private:
    std::optional<time::Checkpoint> last; ///< after the step before
    bool changed = false;                 ///< statuses, in an attempt at this step that was cut
};

/// Takes one step at once.
struct OneStep final : time::StepObserver {
    struct Enough {};
    int attempts = 0;
    model::State state;
    void attempted(const time::Attempt&, const std::vector<equilibrium::IterationRecord>&) override { ++attempts; }
    void accepted(const time::AcceptedStep& step) override {
        state = step.state;
        throw Enough{};
    }
};

/// A step that was cut after statuses had changed in longer attempts is the one taken at once with the length it had in the
/// end.
TEST(Transaction, StepsThatWereCutAfterStatusesChangedAreThoseTakenAtOnce) {
    for (const char* solver : {"condensed", "iterative", "direct"}) {
        SCOPED_TRACE(solver);
        auto overrides = thrown;
        overrides.push_back({"solver.linear_solver", solver});
        const scene::Scene scene = scene::read_scene(support::shipped("validation/falling_block.yaml"), overrides);
        Timings timings;
        app::Plan plan = app::compile(scene, app::build_meshes(scene), 1, timings);
        Cuts cuts;
        time::Stepper(plan.model, plan.stages, plan.stepper, timings).run(cuts);
        EXPECT_GT(cuts.after.size(), 3U);
        for (std::size_t k = 0; k < cuts.after.size(); ++k) {
            time::Stepper again(plan.model, plan.stages, plan.stepper, timings);
            again.resume(cuts.before[k]);
            OneStep step;
            EXPECT_THROW(again.run(step), OneStep::Enough);
            EXPECT_EQ(step.attempts, 1);
            const model::State &one = cuts.after[k], &other = step.state;
            ASSERT_EQ(one.time, other.time);
            ASSERT_EQ(one.u, other.u);
            ASSERT_EQ(one.v, other.v);
            ASSERT_EQ(one.contact[0].lambda, other.contact[0].lambda);
            ASSERT_EQ(one.contact[0].status, other.contact[0].status);
        }
    }
}

TEST(Transaction, ThreadsDoNotChangeABit) {
    expect_same_bits(run("validation/bouncing_rod.yaml", impact, 0, 1),
                     run("validation/bouncing_rod.yaml", impact, 0, 3));
    expect_same_bits(run("paper/half_tube.yaml", slide, 0, 1), run("paper/half_tube.yaml", slide, 0, 3));
}

TEST(Transaction, ThreadsDoNotChangeABitByAnySolver) {
    const support::FloatingPointTraps suspended(false); // PETSc's eigenvalue estimates
    for (const char* solver : {"condensed", "iterative", "multigrid", "direct"}) {
        SCOPED_TRACE(solver);
        auto overrides = slide;
        overrides.push_back({"solver.linear_solver", solver});
        expect_same_bits(run("paper/half_tube.yaml", overrides, 0, 1), run("paper/half_tube.yaml", overrides, 0, 3));
    }
}

/// At every accepted step no point that was open before has gone deeper in the trial than allowed: what is accepted after
/// the contact solve is not deeper either.
TEST(StepControl, KeepsOpenPointsAboveTheAllowedInterpenetration) {
    for (const double allowed : {1e-4, 5e-5}) {
        auto overrides = impact;
        overrides.back().value = std::to_string(allowed);
        const Diary diary = run("validation/bouncing_rod.yaml", overrides, 0);
        EXPECT_GT(diary.count(time::Reason::interpenetration), 0) << "nothing was cut";
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
} // namespace osculate::OSCULATE_THIS_FILE
