/// What KinsolSolver says where there is no solution, and that it never says otherwise.

#include "kinsol_problems.hpp"
#include "osculate/core/error.hpp"
#include "osculate/core/timing.hpp"
#include "osculate/solve/kinsol_solver.hpp"
#include "support/floating_point_traps.hpp"

#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>

namespace osculate::solve::OSCULATE_THIS_FILE {
namespace {

using namespace fixtures;

TEST(KinsolSolver, SaysWhenIterationsAreExhausted) {
    const int n = 5;
    Problem p = cubic(n, Vector::Constant(n * n * n, 1e4));
    Vector u = Vector::Zero(p.size());
    KinsolOptions options = options_for(p);
    options.max_iterations = 2;
    const KinsolResult result = run(p, u, options);
    EXPECT_EQ(result.outcome, KinsolOutcome::max_iterations);
    EXPECT_EQ(result.iterations, 2);
    EXPECT_GT(result.residual, options.tolerance);
}

TEST(KinsolSolver, SaysWhichEquationIsSingular) {
    const int n = 3;
    Problem p = linear(n, Vector::Ones(n * n * n));
    for (SparseIndex k = p.J.row_start[13]; k < p.J.row_start[14]; ++k) p.J.value[k] = 0;
    for (SparseIndex k = 0; k < p.J.nonzeros(); ++k)
        if (p.J.column[k] == 13) p.J.value[k] = 0;
    Vector u = Vector::Zero(p.size());
    KinsolResult result = run(p, u);
    EXPECT_EQ(result.outcome, KinsolOutcome::singular);
    EXPECT_EQ(result.failing_equation, 13);
    p.J.symmetric_positive_definite = false;
    u.setZero();
    result = run(p, u);
    EXPECT_EQ(result.outcome, KinsolOutcome::singular);
    EXPECT_TRUE(u.allFinite());
}

TEST(KinsolSolver, SaysWhenTheResidualIsNotANumber) {
    const support::FloatingPointTraps suspended(false); // the NaN is the point
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()})
        for (const std::size_t evaluation : {0u, 1u}) {
            const int n = 3;
            Problem p = linear(n, Vector::Ones(n * n * n));
            p.evaluate = [&, good = p.evaluate](const Vector& u, VectorRef& F) {
                const Verdict verdict = good(u, F);
                if (p.residuals.size() == evaluation) F(5) = bad;
                return verdict;
            };
            Vector u = Vector::Zero(p.size());
            EXPECT_EQ(run(p, u).outcome, KinsolOutcome::not_finite) << bad << " at evaluation " << evaluation;
        }
}

TEST(KinsolSolver, StopsWhenTheProblemSaysSo) {
    const int n = 5;
    Problem p = cubic(n, Vector::Constant(n * n * n, 1e3));
    p.evaluate = [&, good = p.evaluate](const Vector& u, VectorRef& F) {
        good(u, F);
        return p.residuals.size() == 2 ? Verdict::stop : Verdict::proceed;
    };
    Vector u = Vector::Zero(p.size());
    EXPECT_EQ(run(p, u).outcome, KinsolOutcome::stopped);
    EXPECT_EQ(p.residuals.size(), 3u) << "evaluated on after the stop";
}

TEST(KinsolSolver, ShortensAStepThatCannotBeEvaluated) {
    // Newton from 5 for log z = 0 lands at -3
    Problem p = scalar([](double z) { return z > 0 ? std::log(z) : std::nan(""); }, [](double z) { return 1 / z; });
    Vector z = Vector::Constant(1, 5);
    EXPECT_EQ(run(p, z).outcome, KinsolOutcome::converged);
    EXPECT_NEAR(z(0), 1, 1e-8); // the solver's tolerance and a margin
}

TEST(KinsolSolver, SaysWhenNoStepCanBeEvaluated) {
    Problem p = scalar([](double z) { return z == 5 ? 1 : std::nan(""); }, [](double) { return 1; });
    Vector z = Vector::Constant(1, 5);
    EXPECT_EQ(run(p, z).outcome, KinsolOutcome::not_evaluable);
    z(0) = 4; // not even the start
    EXPECT_EQ(run(p, z).outcome, KinsolOutcome::not_evaluable);
}

TEST(KinsolSolver, ConvergesByLineSearchWhereNewtonDiverges) {
    const auto problem = [] {
        return scalar([](double z) { return std::atan(z); }, [](double z) { return 1 / (1 + z * z); });
    };
    Problem newton = problem(), searched = problem();
    Vector z = Vector::Constant(1, 3);
    EXPECT_NE(run(newton, z).outcome, KinsolOutcome::converged);
    z(0) = 3;
    KinsolOptions options = options_for(searched);
    options.line_search = true;
    EXPECT_EQ(run(searched, z, options).outcome, KinsolOutcome::converged);
    EXPECT_NEAR(z(0), 0, 1e-8);
}

TEST(KinsolSolver, NeverCallsAnUnsolvedProblemConverged) {
    for (const bool line_search : {false, true}) {
        Problem p = scalar([](double z) { return z * z + 1; }, [](double z) { return 2 * z; }); // has no root
        Vector z = Vector::Constant(1, 0.9);
        KinsolOptions options = options_for(p);
        options.line_search = line_search;
        const KinsolResult result = run(p, z, options);
        EXPECT_NE(result.outcome, KinsolOutcome::converged);
        EXPECT_GT(result.residual, 0.9);
    }
}

TEST(KinsolSolver, SaysWhenALineSearchFindsNoDescent) {
    // a tangent of the wrong sign leads uphill
    Problem p = scalar([](double z) { return z * z + 1; }, [](double) { return -1; });
    Vector z = Vector::Constant(1, 0.9);
    KinsolOptions options = options_for(p);
    options.line_search = true;
    EXPECT_EQ(run(p, z, options).outcome, KinsolOutcome::no_descent);
}

struct Mishap : std::runtime_error {
    using std::runtime_error::runtime_error;
};

TEST(KinsolSolver, RethrowsWhatTheProblemThrows) {
    const int n = 3;
    Timings timings;
    KinsolSolver solver(n * n * n, timings);
    Vector u = Vector::Zero(n * n * n);
    Problem in_residual = linear(n, Vector::Ones(n * n * n));
    in_residual.evaluate = [](const Vector&, VectorRef&) -> Verdict { throw Mishap("residual"); };
    EXPECT_THROW((void)solver.solve(in_residual, u, options_for(in_residual)), Mishap);
    Problem in_tangent = linear(n, Vector::Ones(n * n * n));
    in_tangent.linearise = [](const Vector&, SparseMatrix&) { throw Mishap("tangent"); };
    EXPECT_THROW((void)solver.solve(in_tangent, u, options_for(in_tangent)), Mishap);
    Problem good = linear(n, Vector::Ones(n * n * n)); // and is none the worse for it
    u.setZero();
    EXPECT_EQ(solver.solve(good, u, options_for(good)).outcome, KinsolOutcome::converged);
}

TEST(KinsolSolver, RefusesSizesThatDiffer) {
    Timings timings;
    KinsolSolver solver(5, timings);
    Problem p = linear(3, Vector::Ones(27));
    Vector u = Vector::Zero(27);
    EXPECT_THROW((void)solver.solve(p, u, options_for(p)), InternalError);
}

TEST(KinsolOutcome, HasAnExplanationForEachValue) {
    std::vector<std::string> texts;
    for (int k = 0; k <= static_cast<int>(KinsolOutcome::not_finite); ++k)
        texts.push_back(describe(static_cast<KinsolOutcome>(k)));
    std::sort(texts.begin(), texts.end());
    EXPECT_EQ(std::unique(texts.begin(), texts.end()), texts.end());
    EXPECT_EQ(std::count(texts.begin(), texts.end(), "unknown"), 0);
}

} // namespace
} // namespace osculate::solve::OSCULATE_THIS_FILE
