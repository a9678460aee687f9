#include "osculate/linear/reduced_gmres.hpp"

#include "equilibrium/press.hpp"
#include "support/floating_point_traps.hpp"

#include <gtest/gtest.h>
#include <limits>
#include <optional>

namespace osculate::equilibrium::OSCULATE_THIS_FILE {
namespace {

using contact::Status;
using fixtures::Press;

/// What x leaves of b, |b - J x|, for the tangent at the last residual; none: GMRES on all unknowns would be asked.
std::optional<double> left_over(Press& press, const Vector& b, double allowed) {
    Vector x(b.size()), Jx(b.size());
    solve::Tangent& tangent = *press.equilibrium->tangent();
    tangent.linearise();
    const auto result = press.equilibrium->preconditioner()->solve_with(b, x, allowed);
    if (!result) return std::nullopt;
    EXPECT_TRUE(result->converged);
    tangent.multiply(x, Jx);
    return (b - Jx).norm();
}

/// The factors are those of contact that sticks, at every node but a few. Contact is then the same, or slides, or elsewhere, or
/// leaves off at nodes that have a spring, or begins at nodes that have none.
TEST(ReducedGmres, SolvesWithTheTangentWhateverContactTheFactorsWereMadeFor) {
    constexpr std::size_t few = 3;
    struct Case {
        Status status;
        std::size_t open;
        double rear;
    };
    for (const auto& [status, open, rear] : {Case{Status::stick, few, 0},
                                             {Status::slip, few, 0.01},
                                             {Status::slip, few, 0.3},
                                             {Status::slip, 2 * few, 0},
                                             {Status::stick, 0, 0}}) {
        Press press(LinearSolver::iterative);
        press.accept(press.attempt(0, {press.all(Status::stick, few)}));
        const solve::Wear before = press.equilibrium->preconditioner()->wear();
        ASSERT_TRUE(before.usable);
        const Vector z = press.attempt(rear, {});
        press.equilibrium->set_statuses(press.all(status, open), StatusRule::frozen, true);
        Vector F(z.size());
        ASSERT_EQ(press.equilibrium->residual(z, F), solve::NonlinearProblem::Verdict::proceed);
        for (const double allowed : {1e-3, 1e-9}) { // of a norm of about ten; beyond single precision, too
            const Vector b = Vector::LinSpaced(z.size(), -1, 2);
            const std::optional<double> left = left_over(press, b, allowed);
            ASSERT_TRUE(left.has_value()) << rear << ' ' << open << ' ' << allowed;
            EXPECT_LE(*left, 2 * allowed) << rear << ' ' << open;
        }
    }
}

TEST(ReducedGmres, LeavesAVectorThatIsNoNumberToOthers) {
    Press press(LinearSolver::iterative);
    press.accept(press.attempt(0, {press.all(Status::stick)}));
    const Vector b = Vector::Constant(press.equilibrium->size(), std::numeric_limits<double>::quiet_NaN());
    Vector x(b.size());
    press.equilibrium->tangent()->linearise();
    const support::FloatingPointTraps suspended(false);
    const auto result = press.equilibrium->preconditioner()->solve_with(b, x, 1);
    EXPECT_TRUE(!result || !result->converged);
}

} // namespace
} // namespace osculate::equilibrium::OSCULATE_THIS_FILE
