#include "osculate/time/post_mortem.hpp"

#include "osculate/app/advice.hpp"
#include "osculate/app/compile.hpp"
#include "osculate/output/post_mortem_file.hpp"
#include "osculate/scene/reader.hpp"
#include "support/source_tree.hpp"

#include <algorithm>
#include <functional>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tuple>
#include <utility>

namespace osculate::time::OSCULATE_THIS_FILE {
namespace {

using testing::HasSubstr;

const std::vector<scene::Override> no_loose_body{{"supports.top", "{fix: [y, z]}"}};

/// What is found of a solve of a small scene that came to an end without a solution. The outcome is given, not computed.
/// @param statuses  of the iterates before it
/// @param supports  changes to those of the scene
PostMortem examined(const LadderResult& result, const LadderOptions& ladder, Attempt& attempt,
                    const std::function<std::vector<equilibrium::Statuses>(equilibrium::Statuses)>& statuses = {},
                    const std::vector<scene::Override>& supports = no_loose_body) {
    const scene::Scene scene = scene::read_scene(support::source_tree() + "/tests/scenes/press.yaml", supports);
    Timings timings;
    app::Plan plan = app::compile(scene, app::build_meshes(scene), 1, timings);
    const Stage& stage = plan.stages.front();
    const linear::Constraints constraints(plan.model.nodes(), stage.constraints);
    equilibrium::Equilibrium equilibrium(
        plan.model, plan.model.pairs, constraints, nullptr,
        equilibrium::choose_tangent(plan.model, plan.model.pairs, LinearSolver::automatic, false, false), timings, 1);
    model::State state;
    state.u.assign(plan.model.X.size(), Vec3::Zero());
    for (const auto& pair : plan.model.pairs) state.contact.push_back(model::opened(pair));
    equilibrium.begin_attempt(state, {state.u, state.u}, 1);
    const Vector z = equilibrium.unknowns(state.u, state.contact);
    equilibrium.set_reference_force(ladder.reference_force);
    if (statuses)
        for (const equilibrium::Statuses& imposed : statuses(equilibrium.statuses())) {
            Vector F(z.size());
            equilibrium.set_statuses(imposed, equilibrium::StatusRule::frozen, false);
            (void)equilibrium.residual(z, F);
        }
    Decision decision;
    decision.verdict = Verdict::give_up;
    decision.reason = Reason::solver;
    attempt.cause = explain(plan.model, result, equilibrium, attempt);
    const std::vector<Attempt> attempts{attempt};
    const FailedAttempt failed{plan.model, stage, state, z, result, ladder, decision, attempts};
    const FailedIterate iterate{failed, state, equilibrium};
    return app::advised(examine(failed, equilibrium), &iterate);
}

/// The failure itself needs a scene of more than 100 000 nodes; here its outcome is given, and the words are looked at.
TEST(PostMortem, NamesALinearSystemThatWasNotSolvedAndWhatToDo) {
    LadderResult result;
    result.outcome = solve::KinsolOutcome::unsolved;
    LadderOptions ladder;
    ladder.reference_force = 1;
    Attempt attempt;
    const PostMortem found = examined(result, ladder, attempt);
    EXPECT_THAT(attempt.cause, HasSubstr("linear system not solved"));
    EXPECT_THAT(attempt.cause, HasSubstr("too large to be factorised"));
    EXPECT_EQ(found.cause, Cause::linear_system);
    const std::string words = output::in_words(found);
    EXPECT_THAT(words, HasSubstr("linear_system: "));
    EXPECT_THAT(words, HasSubstr("--set 'solver.linear_solver=iterative'"));
}

TEST(PostMortem, AdvisesALargerToleranceWhereTheResidualIsSmallAnyhow) {
    LadderResult result;
    result.outcome = solve::KinsolOutcome::stopped;
    LadderOptions ladder;
    ladder.reference_force = 1;
    Attempt attempt;
    const std::string tolerance = "--set 'solver.tolerance=";
    result.residual = 4e-7; // far above the tolerance, and yet nothing that would be seen in a result
    EXPECT_THAT(output::in_words(examined(result, ladder, attempt)), HasSubstr(tolerance + "8e-07'"));
    result.residual = 1e-3;
    EXPECT_THAT(output::in_words(examined(result, ladder, attempt)), testing::Not(HasSubstr(tolerance)));
}

TEST(PostMortem, NamesTheNodeThatChangedItsStatusMostOften) {
    LadderResult result;
    result.outcome = solve::KinsolOutcome::stopped;
    LadderOptions ladder;
    ladder.reference_force = 1;
    Attempt attempt;
    constexpr std::size_t once = 1, often = 4, twice = 9;
    using contact::Status;
    const PostMortem found = examined(result, ladder, attempt, [&](equilibrium::Statuses now) {
        std::vector<equilibrium::Statuses> history{now};
        const auto change = [&](std::size_t slave, Status to) {
            now[0][slave] = to;
            history.push_back(now);
        };
        change(once, Status::stick);
        change(twice, Status::stick);
        for (const Status to : {Status::slip, Status::stick, Status::slip}) change(often, to);
        change(twice, Status::slip);
        return history;
    });
    EXPECT_EQ(found.changing, 3);
    ASSERT_EQ(found.changes.size(), 3U);
    for (const auto& [place, slave, length] : {std::tuple{0U, often, 4U}, {1U, twice, 3U}, {2U, once, 2U}}) {
        EXPECT_EQ(found.changes[place].body, "cap");
        EXPECT_EQ(found.changes[place].node, static_cast<Index>(slave)) << place; // z_min has its body's first nodes
        EXPECT_EQ(found.changes[place].sequence.size(), length) << place;
    }
    EXPECT_EQ(found.cause, Cause::status_cycle);
    ASSERT_TRUE(found.contact); // the node least in balance is no slave: it is the one that changes most that is shown
    EXPECT_EQ(found.contact->pair, "joint");
    EXPECT_EQ(found.contact->status, Status::slip);
}

/// Held along x alone, the cap may move along y and z and turn about x; what it stands on leaves it y, unless it sticks.
TEST(PostMortem, CountsSlippingNodesAsSupportsAlongTheNormalAlone) {
    LadderResult result;
    result.outcome = solve::KinsolOutcome::stopped;
    LadderOptions ladder;
    ladder.reference_force = 1;
    using contact::Status;
    for (const auto& [status, free] : {std::pair{Status::stick, 0}, {Status::slip, 1}, {Status::glide, 1}}) {
        Attempt attempt;
        const auto all = [&](equilibrium::Statuses now) {
            std::ranges::fill(now[0], status);
            return std::vector<equilibrium::Statuses>{now};
        };
        const PostMortem found = examined(result, ladder, attempt, all, {});
        const auto cap = std::ranges::find(found.bodies, "cap", &BodyHold::body);
        ASSERT_NE(cap, found.bodies.end());
        EXPECT_EQ(cap->free_by_supports, 3);
        EXPECT_EQ(cap->free_with_contact, free) << name(status);
        EXPECT_EQ(cap->touching, 16);
    }
}

} // namespace
} // namespace osculate::time::OSCULATE_THIS_FILE
