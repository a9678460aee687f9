/// An attempt that is rolled back leaves nothing behind in an Equilibrium, however far it went.

#include "osculate/equilibrium/equilibrium.hpp"

#include "equilibrium/press.hpp"
#include "support/random.hpp"
#include "support/source_tree.hpp"
#include "support/thread_ranks.hpp"

#include <gtest/gtest.h>

namespace osculate::equilibrium::OSCULATE_THIS_FILE {
namespace {

using contact::Status;
using fixtures::Press;

class Rollback : public ::testing::TestWithParam<LinearSolver> {};

/// More nodes closed, and those of before again with other statuses: laws and patterns that the next step could go on with.
constexpr std::size_t open = 3;
std::vector<Statuses> other_statuses(const Press& press) {
    return {press.all(Status::slip), press.all(Status::slip, open)};
}

TEST_P(Rollback, LeavesNoTraceOfAnAttemptWithOtherStatuses) {
    for (const double there : {0.01, 0.3}) { // on the same facets and on others
        Press straight(GetParam()), rejected(GetParam());
        for (Press* press : {&straight, &rejected}) press->accept(press->attempt(0, {press->all(Status::stick, open)}));
        (void)rejected.attempt(there, other_statuses(rejected));
        rejected.equilibrium->rollback();
        for (const double rear : {0.01, 0.02}) { // and whatever is made of it is kept
            const Vector one = straight.attempt(rear, {straight.all(Status::slip, open)}),
                         other = rejected.attempt(rear, {rejected.all(Status::slip, open)});
            ASSERT_EQ(one, other) << "other digits than without the rejected attempt to " << there;
            straight.accept(one);
            rejected.accept(other);
        }
    }
}

TEST_P(Rollback, ComesBackToWhatAMemoryRecalls) {
    Press straight(GetParam()), resumed(GetParam());
    straight.accept(straight.attempt(0, {straight.all(Status::stick, open)}));
    resumed.state = straight.state;
    resumed.equilibrium->recall(straight.equilibrium->memory());
    (void)resumed.attempt(0.01, other_statuses(resumed));
    resumed.equilibrium->rollback();
    ASSERT_EQ(straight.attempt(0.01, {straight.all(Status::slip, open)}),
              resumed.attempt(0.01, {resumed.all(Status::slip, open)}));
}

TEST(Equilibrium, LeavesNoForceOnOpenNodes) {
    Press press(LinearSolver::direct);
    press.accept(press.attempt(0, {press.all(Status::stick, open)}));
    model::State shaken = press.state; // as the last digits of a solver do
    const Vec3 round_off = Vec3::Constant(1e-12);
    for (Vec3& lambda : shaken.contact[0].lambda) lambda += round_off;
    const Vector z = press.equilibrium->unknowns(shaken.u, shaken.contact);
    const model::State state = press.equilibrium->state(z);
    for (std::size_t j = 0; j < state.contact[0].lambda.size(); ++j)
        EXPECT_EQ(state.contact[0].lambda[j], j < open ? Vec3(Vec3::Zero()) : shaken.contact[0].lambda[j]) << j;
}

/// c of the complementarity functions has inertia beside stiffness, which grows with the inverse square of the step.
TEST(Equilibrium, WeighsContactWithTheInertiaOfTheStep) {
    const std::string density = "1000 kg/m^3";
    const scene::Scene scene = scene::read_scene(support::source_tree() + "/tests/scenes/press.yaml",
                                                 {{"bodies.base.material.linear_elastic.density", density},
                                                  {"bodies.cap.material.linear_elastic.density", density},
                                                  {"stages.pull.analysis", "dynamic"}});
    Timings timings;
    app::Plan plan = app::compile(scene, app::build_meshes(scene), 1, timings);
    const time::Stage& pull = plan.stages[1];
    const linear::Constraints constraints(plan.model.nodes(), pull.constraints);
    Equilibrium equilibrium(plan.model, plan.model.pairs, constraints, &*pull.dynamics, pull.tangent, timings, 1);
    model::State state;
    state.u.assign(plan.model.X.size(), Vec3::Zero());
    state.v = state.a = state.u;
    const model::ContactPair& pair = *plan.model.pairs[0];
    state.contact.push_back(model::opened(plan.model.pairs[0]));
    std::vector<double> by_step;
    for (const double dt : {1e-3, 5e-4}) {
        equilibrium.begin_attempt(state, {state.u, state.u, {}}, dt);
        const double c = equilibrium.contact()[0].stiffness(0, Vec3::Zero());
        by_step.push_back(c - pair.slaves().stiffness[0]);
        EXPECT_DOUBLE_EQ(c, pair.slaves().stiffness[0] + equilibrium.bodies().inertia(pair.slaves().node[0]));
    }
    EXPECT_GT(by_step[0], 0);
    EXPECT_NEAR(by_step[1], 4 * by_step[0], 1e-9 * by_step[1]);
}

/// A rung that begins again where an earlier one did, or between two iterates, begins there whoever solves.
TEST(Equilibrium, ComesBackToIteratesWhetherOneProcessKeepsThemOrSeveral) {
    for (const int count : {1, 2, 5})
        support::on_ranks(count, [&](const std::shared_ptr<Ranks>& ranks) {
            Press press(LinearSolver::iterative, ranks->count() > 1 ? ranks : nullptr);
            Equilibrium& equilibrium = *press.equilibrium;
            const Vector start = press.begin(0.01);
            equilibrium.set_statuses(press.all(Status::stick, open), StatusRule::frozen, false);
            support::Random random(7); // the same numbers in all processes
            const auto iterate = [&] {
                Vector z = start;
                for (double& value : z) value += 1e-6 * random.uniform();
                return z;
            };
            const Vector one = iterate(), other = iterate(), next = iterate();
            ASSERT_NE(one, other);
            Vector F(one.size());
            for (const Vector* z : {&one, &other}) (void)equilibrium.residual(*z, F);
            EXPECT_EQ(equilibrium.midpoint(), 0.5 * (one + other)) << ranks->rank() << " of " << ranks->count();
            (void)equilibrium.residual(next, F);
            EXPECT_EQ(equilibrium.midpoint(), 0.5 * (other + next)) << ranks->rank() << " of " << ranks->count();

            const Vector kept = equilibrium.kept(one);
            EXPECT_EQ(kept.size() < one.size(), ranks->count() > 1) << "a process has others' unknowns as well";
            EXPECT_EQ(equilibrium.restored(kept), one) << ranks->rank() << " of " << ranks->count();
        });
}

INSTANTIATE_TEST_SUITE_P(Solvers, Rollback,
                         ::testing::Values(LinearSolver::condensed, LinearSolver::iterative, LinearSolver::direct),
                         [](const auto& solver) {
                             return solver.param == LinearSolver::condensed   ? "condensed"
                                    : solver.param == LinearSolver::iterative ? "iterative"
                                                                              : "direct";
                         });

} // namespace
} // namespace osculate::equilibrium::OSCULATE_THIS_FILE
