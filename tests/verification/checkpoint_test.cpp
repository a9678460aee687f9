/// A run that goes on from a checkpoint is, to the last bit, the run that never stopped.

#include "osculate/output/checkpoint_file.hpp"
#include "support/diary.hpp"
#include "support/floating_point_traps.hpp"

#include <gtest/gtest.h>
#include <string>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

using support::Diary;
using Overrides = std::vector<scene::Override>;

/// A scene's run, or the rest of it, with checkpoints as files hold them.
struct PartOfARun {
    PartOfARun(const std::string& name, const Overrides& overrides, int threads = 1) {
        const scene::Scene scene = scene::read_scene(support::shipped(name), overrides);
        plan = app::compile(scene, app::build_meshes(scene), threads, timings);
    }
    void go(std::size_t checkpoint_every, const std::string* from = nullptr) {
        time::Stepper stepper(plan.model, plan.stages, plan.stepper, timings);
        if (from != nullptr) stepper.resume(output::decode(*from).run);
        diary.every = checkpoint_every;
        stepper.run(diary);
        refreshed = stepper.counts().refreshed_patches;
        paths = stepper.counts().paths_followed;
    }
    struct Checkpoints final : time::StepObserver {
        Diary diary;
        std::size_t every = 0;
        std::vector<std::string> files;
        std::vector<std::size_t> attempts; ///< that lie behind
        void attempted(const time::Attempt& a, const std::vector<equilibrium::IterationRecord>& i) override {
            diary.attempted(a, i);
        }
        void accepted(const time::AcceptedStep& step) override { diary.accepted(step); }
        void between_steps(const std::function<time::Checkpoint()>& checkpoint) override {
            if (every == 0 || diary.states.size() % every != 0) return;
            output::CheckpointFile file;
            file.run = checkpoint();
            files.push_back(output::encode(file));
            attempts.push_back(diary.attempts.size());
        }
    };
    Timings timings;
    app::Plan plan;
    Checkpoints diary;
    long refreshed = 0, paths = 0;
};

void expect_resumes(const std::string& scene, const Overrides& overrides, std::size_t every, int threads = 1) {
    PartOfARun straight(scene, overrides);
    straight.go(every);
    PartOfARun without(scene, overrides); // taking checkpoints changes nothing
    without.go(0);
    ASSERT_EQ(straight.diary.diary.states.size(), without.diary.diary.states.size());
    support::expect_same_bits(straight.diary.diary, without.diary.diary);
    ASSERT_GT(straight.diary.files.size(), 1U);
    for (std::size_t k = 0; k < straight.diary.files.size(); ++k) {
        SCOPED_TRACE(k);
        PartOfARun rest(scene, overrides, threads);
        rest.go(0, &straight.diary.files[k]);
        const auto &all = straight.diary.diary.attempts, &late = rest.diary.diary.attempts;
        ASSERT_EQ(straight.diary.attempts[k] + late.size(), all.size());
        ASSERT_EQ((k + 1) * every + rest.diary.diary.states.size(), straight.diary.diary.states.size());
        if (!rest.diary.diary.states.empty()) // the last checkpoint may be of the last step
            support::expect_same_end(straight.diary.diary, rest.diary.diary);
        for (std::size_t a = 0; a < late.size(); ++a) {
            const time::Attempt& before = all[straight.diary.attempts[k] + a];
            ASSERT_EQ(before.attempt, late[a].attempt);
            ASSERT_EQ(before.dt, late[a].dt);
            ASSERT_EQ(before.iterations, late[a].iterations);
            ASSERT_EQ(before.reason, late[a].reason);
            ASSERT_EQ(before.value, late[a].value);
        }
        EXPECT_EQ(straight.refreshed, rest.refreshed);
        EXPECT_EQ(straight.paths, rest.paths);
    }
}

TEST(Checkpoint, ResumesASlide) {
    expect_resumes("paper/half_tube.yaml", support::slide, 1);
}

TEST(Checkpoint, ResumesASlideByEverySolver) {
    const support::FloatingPointTraps suspended(false); // PETSc's eigenvalue estimates
    for (const char* solver : {"condensed", "iterative", "multigrid", "direct"}) {
        SCOPED_TRACE(solver);
        Overrides overrides = support::slide;
        overrides.push_back({"solver.linear_solver", solver});
        expect_resumes("paper/half_tube.yaml", overrides, 3, 2);
    }
}

TEST(Checkpoint, ResumesWithAveragesOverFacets) {
    for (const char* discretisation : {"mortar", "petrov_galerkin"}) {
        SCOPED_TRACE(discretisation);
        Overrides overrides = support::slide;
        overrides.push_back({"contact.sliding.discretisation", discretisation});
        expect_resumes("paper/half_tube.yaml", overrides, 3);
    }
}

TEST(Checkpoint, ResumesAThrowWithFrictionAmidCuts) {
    expect_resumes("validation/falling_block.yaml", support::thrown, 16);
}

TEST(Checkpoint, ResumesAnImpact) {
    expect_resumes("validation/bouncing_rod.yaml", support::impact, 60);
}

TEST(Checkpoint, ResumesRubberByEverySolver) {
    const support::FloatingPointTraps suspended(false);
    for (const char* solver : {"iterative", "multigrid", "direct"}) {
        SCOPED_TRACE(solver);
        Overrides rubber = support::thrown;
        rubber.push_back({"bodies.block.material", "{neo_hookean: {E: 1 MPa, nu: 0.3, density: 1000 kg/m^3}}"});
        rubber.push_back({"stages.fall.follower_pressure", "{underside: 100 Pa}"});
        rubber.push_back({"solver.linear_solver", solver});
        expect_resumes("validation/falling_block.yaml", rubber, 12);
    }
}

TEST(Checkpoint, ResumesARunThatRejectsOnPurpose) {
    PartOfARun straight("paper/half_tube.yaml", support::slide), rest("paper/half_tube.yaml", support::slide);
    straight.plan.stepper.reject_every = rest.plan.stepper.reject_every = 3;
    straight.go(4);
    rest.go(0, &straight.diary.files.front());
    EXPECT_GT(rest.diary.diary.count(time::Reason::forced), 0);
    support::expect_same_end(straight.diary.diary, rest.diary.diary);
}

/// Every byte of a file counts: cut off anywhere, or with a bit turned over, it is refused.
TEST(Checkpoint, IsRefusedWhereItIsDamaged) {
    PartOfARun run("paper/half_tube.yaml", support::slide);
    run.go(4);
    const std::string& good = run.diary.files.front();
    EXPECT_NO_THROW((void)output::decode(good));
    for (std::size_t k = 0; k < good.size(); k += 1 + good.size() / 199) {
        EXPECT_THROW((void)output::decode(good.substr(0, k)), std::runtime_error) << k;
        std::string bad = good;
        bad[k] = static_cast<char>(bad[k] ^ 4);
        EXPECT_THROW((void)output::decode(bad), std::runtime_error) << k;
    }
}

/// A checkpoint that is whole but does not fit the scene is told so, whatever it holds.
TEST(Checkpoint, OfAnotherSceneIsRefused) {
    PartOfARun run("paper/half_tube.yaml", support::slide);
    run.go(4);
    const auto refused = [&](const std::function<void(time::Checkpoint&)>& change) {
        time::Checkpoint checkpoint = output::decode(run.diary.files.front()).run;
        change(checkpoint);
        time::Stepper stepper(run.plan.model, run.plan.stages, run.plan.stepper, run.timings);
        EXPECT_THROW(stepper.resume(std::move(checkpoint)), RunFailure);
    };
    refused([](time::Checkpoint& c) { c.state.u.values().pop_back(); });
    refused([](time::Checkpoint& c) { c.state.u[0].x() = std::nan(""); });
    refused([](time::Checkpoint& c) { c.state.contact.pop_back(); });
    refused([](time::Checkpoint& c) { c.state.contact[0].facet[0] = 1 << 30; });
    refused([](time::Checkpoint& c) { c.state.contact[0].status[0] = static_cast<contact::Status>(9); });
    refused([](time::Checkpoint& c) { c.stage = 2; });
    refused([](time::Checkpoint& c) { c.dt = 0; });
    refused([](time::Checkpoint& c) { c.patches[0].push_back({1 << 30, {}}); });
    refused([](time::Checkpoint& c) {
        c.memory.laws.emplace();
        c.memory.laws->couplings = {-1};
    });
    refused([](time::Checkpoint& c) {
        c.memory.factors.emplace();
        c.memory.factors->contacts = std::make_shared<std::vector<linear::SoftContact>>();
    });
    refused([](time::Checkpoint& c) { c.memory.springs = {{linear::Spring{1 << 30, {}, {}}}}; });
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
