#include "osculate/time/post_mortem.hpp"

#include "osculate/app/compile.hpp"
#include "osculate/output/post_mortem_file.hpp"
#include "osculate/scene/reader.hpp"
#include "support/source_tree.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace osculate::time {
namespace {

using testing::HasSubstr;

/// What is found of a solve of a small scene that came to an end without a solution. The outcome is given, not computed.
PostMortem examined(const LadderResult& result, const LadderOptions& ladder, Attempt& attempt) {
    const scene::Scene scene = scene::read_scene(support::source_tree() + "/tests/scenes/press.yaml",
                                                 {{"supports.top", "{fix: [y, z]}"}}); // so that no body is loose
    Timings timings;
    app::Plan plan = app::compile(scene, app::build_meshes(scene), 1, timings);
    const Stage& stage = plan.stages.front();
    const model::Constraints constraints(plan.model.nodes(), stage.constraints);
    Equilibrium equilibrium(plan.model, constraints, nullptr, timings, 1);
    model::State state;
    state.u.assign(plan.model.X.size(), Vec3::Zero());
    for (const auto& pair : plan.model.pairs) state.contact.push_back(pair->initial_history());
    equilibrium.begin_attempt(state, {state.u, state.u}, 1);
    const Vector z = equilibrium.unknowns(state.u, state.contact);
    equilibrium.set_reference_force(ladder.reference_force);
    Decision decision;
    decision.verdict = Verdict::give_up;
    decision.reason = Reason::solver;
    attempt.cause = explain(plan.model, result, equilibrium, attempt);
    return examine({plan.model, stage, state, z, result, ladder, decision, {attempt}}, equilibrium);
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

} // namespace
} // namespace osculate::time
