#include "osculate/time/finite_check.hpp"

#include "support/scene_runner.hpp"

#include <gtest/gtest.h>
#include <limits>

namespace osculate::time {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// A block pressed on another, as accepted.
class FiniteCheck : public testing::Test {
protected:
    FiniteCheck() {
        support::run_scene(run_, OSCULATE_SOURCE_DIR "/tests/scenes/press.yaml");
        state_ = run_.steps.back().state;
        state_.v.assign(state_.u.size(), Vec3::Zero());
        state_.a.assign(state_.u.size(), Vec3::Zero());
    }

    [[nodiscard]] const model::Model& model() const { return run_.plan.model; }
    [[nodiscard]] std::optional<NotFinite> found() const { return find_not_finite(model(), state_, &ledger_); }

    support::SceneRun run_;
    model::State state_;
    Ledger ledger_;
};

TEST_F(FiniteCheck, FindsNothingInAStateThatIsSound) {
    EXPECT_FALSE(found());
    EXPECT_FALSE(find_not_finite(model(), state_, nullptr));
}

TEST_F(FiniteCheck, NamesTheFieldAndTheNode) {
    const std::vector<std::pair<std::string, std::vector<Vec3>*>> fields{
        {"displacement", &state_.u}, {"velocity", &state_.v}, {"acceleration", &state_.a}};
    for (const auto& [name, field] : fields)
        for (const Index node : {Index{0}, model().nodes() - 1}) {
            const double before = (*field)[node].z();
            (*field)[node].z() = -infinity;
            const auto fault = found();
            (*field)[node].z() = before;
            ASSERT_TRUE(fault) << name;
            EXPECT_EQ(fault->what, name);
            EXPECT_EQ(fault->node, node);
            EXPECT_EQ(fault->value, -infinity);
        }
}

TEST_F(FiniteCheck, LooksAtForcesOfSlaveNodes) {
    const Index last = model().pairs[0]->size() - 1;
    state_.contact[0].lambda[last].y() = nan;
    const auto fault = found();
    ASSERT_TRUE(fault);
    EXPECT_EQ(fault->what, "contact force");
    EXPECT_EQ(fault->node, model().pairs[0]->slaves().node[last]);
}

TEST_F(FiniteCheck, LooksAtTheLedgerOfADynamicStepOnly) {
    ledger_.balance = nan;
    ASSERT_TRUE(found());
    EXPECT_EQ(found()->what, "energy.balance");
    EXPECT_EQ(found()->node, -1);
    EXPECT_FALSE(find_not_finite(model(), state_, nullptr));
    ledger_.balance = 0;
    ledger_.angular.x() = infinity;
    ASSERT_TRUE(found());
    EXPECT_EQ(found()->what, "angular momentum");
}

TEST_F(FiniteCheck, WordsNameTheNodeOfTheBody) {
    const model::Body& cap = model().bodies[1];
    Attempt attempt;
    explain({"velocity", cap.first_node + 3, infinity}, model(), attempt);
    EXPECT_EQ(attempt.body, "cap");
    EXPECT_EQ(attempt.node, 3);
    EXPECT_EQ(attempt.cause, "velocity of node 3 of body 'cap' is inf where the residual is within tolerance");
}

TEST_F(FiniteCheck, WordsWithoutANodeForgetTheOneBefore) {
    Attempt attempt;
    attempt.body = "cap";
    attempt.node = 3;
    explain({"energy.strain", -1, infinity}, model(), attempt);
    EXPECT_EQ(attempt.body, "");
    EXPECT_EQ(attempt.node, -1);
    EXPECT_EQ(attempt.cause, "energy.strain is inf where the residual is within tolerance");
}

} // namespace
} // namespace osculate::time
