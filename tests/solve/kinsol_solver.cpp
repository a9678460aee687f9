#include "osculate/solve/kinsol_solver.hpp"

#include "kinsol_problems.hpp"
#include "osculate/core/error.hpp"
#include "osculate/core/timing.hpp"

#include <algorithm>
#include <cmath>
#include <functional>
#include <gtest/gtest.h>
#include <limits>

namespace osculate::solve::OSCULATE_THIS_FILE {
namespace {

using namespace fixtures;

TEST(KinsolSolver, ConvergesQuadratically) {
    const int n = 20; // 8000 unknowns
    Problem p = cubic(n, Vector::Constant(n * n * n, 10));
    Vector u = Vector::Zero(p.size());
    KinsolOptions options = options_for(p);
    options.tolerance = 1e-10;
    const KinsolResult result = run(p, u, options);
    EXPECT_EQ(result.outcome, KinsolOutcome::converged);
    EXPECT_LE(result.residual, options.tolerance);
    EXPECT_EQ(result.residual, p.residuals.back());
    ASSERT_GE(p.residuals.size(), 5u);
    EXPECT_EQ(result.iterations + 1, static_cast<int>(p.residuals.size())); // one evaluation an iterate
    EXPECT_EQ(result.factorisations, result.iterations);
    const double round_off = 1e-12; // of residuals, forces of order ten
    for (std::size_t k = p.residuals.size() - 3; k < p.residuals.size(); ++k)
        EXPECT_LT(p.residuals[k], p.residuals[k - 1] * p.residuals[k - 1] + round_off);
    Vector F(p.size());
    VectorRef map = F;
    p.evaluate(u, map);
    EXPECT_LE(F.cwiseAbs().maxCoeff(), options.tolerance) << "u is not the iterate that was judged";
}

TEST(KinsolSolver, SolvesALinearSystemInOneIteration) {
    const int n = 6;
    Problem p = linear(n, Vector::Constant(n * n * n, 1e6)); // far from the start: no step may be cut
    Vector u = Vector::Zero(p.size());
    KinsolOptions options = options_for(p);
    options.residual_scale = 1e-6;
    const KinsolResult result = run(p, u, options);
    EXPECT_EQ(result.outcome, KinsolOutcome::converged);
    EXPECT_EQ(result.iterations, 1);
    EXPECT_EQ(result.factorisations, 1);
    EXPECT_GT(u.maxCoeff(), 1e5);
}

TEST(KinsolSolver, NeedsNoIterationFromTheSolution) {
    const int n = 4;
    Problem p = cubic(n, Vector::Zero(n * n * n));
    Vector u = Vector::Zero(p.size());
    const KinsolResult result = run(p, u);
    EXPECT_EQ(result.outcome, KinsolOutcome::converged);
    EXPECT_EQ(result.iterations, 0);
    EXPECT_EQ(result.factorisations, 0);
    EXPECT_EQ(u, Vector::Zero(p.size()));
}

TEST(KinsolSolver, MeasuresTheResidualWithItsScale) {
    const int n = 4;
    const auto residual_left = [&](double scale) {
        Problem p = cubic(n, Vector::Constant(n * n * n, 10));
        Vector u = Vector::Zero(p.size());
        KinsolOptions options = options_for(p);
        options.tolerance = 1e-3;
        options.residual_scale = scale;
        const KinsolResult result = run(p, u, options);
        EXPECT_EQ(result.outcome, KinsolOutcome::converged);
        EXPECT_DOUBLE_EQ(result.residual, p.residuals.back() * scale);
        return p.residuals.back();
    };
    EXPECT_GT(residual_left(0.1), 1e-5); // 1e-2 allowed: stops earlier
    EXPECT_LT(residual_left(1000), 1e-6);
}

/// Membrane under a load, over an obstacle: min(K u - f, u - psi) = 0, solved as a semismooth equation.
TEST(KinsolSolver, SolvesAnObstacleProblem) {
    const int n = 12;
    const SparseMatrix K = laplacian(n);
    const Vector f = Vector::Constant(n * n * n, -0.2), psi = Vector::Constant(n * n * n, -0.5);
    Problem p;
    p.J = K;
    p.J.symmetric_positive_definite = false;
    const auto force = [&](const Vector& u) {
        Vector r(u.size());
        K.multiply(u.data(), r.data());
        return Vector(r - f);
    };
    p.evaluate = [&](const Vector& u, VectorRef& F) {
        F = force(u).cwiseMin(u - psi);
        return Verdict::proceed;
    };
    p.linearise = [&](const Vector& u, SparseMatrix& J) {
        const Vector r = force(u);
        J.value = K.value;
        for (Index i = 0; i < u.size(); ++i)
            if (u(i) - psi(i) < r(i)) {
                std::fill(J.value.begin() + J.row_start[i], J.value.begin() + J.row_start[i + 1], 0.0);
                diagonal(J, i) = 1;
            }
    };
    Vector u = Vector::Zero(p.size());
    const KinsolResult result = run(p, u);
    EXPECT_EQ(result.outcome, KinsolOutcome::converged);
    const Vector r = force(u);
    const double solved = 1e-9; // the solver's tolerance
    EXPECT_GT((u - psi).minCoeff(), -solved) << "through the obstacle";
    EXPECT_GT(r.minCoeff(), -solved) << "the obstacle pulls";
    EXPECT_LT(r.cwiseProduct(u - psi).cwiseAbs().maxCoeff(), solved);
    const auto touching = (u - psi).cwiseAbs().array() < solved;
    EXPECT_GT(touching.count(), 0);
    EXPECT_LT(touching.count(), u.size());
    const double round_off = 1e-12; // once the active set is right the problem is linear: no tail at all
    EXPECT_LT(p.residuals.back(), round_off);
}

TEST(KinsolSolver, KeepsTheFactorOfATangentThatHasNotChanged) {
    const int n = 6;
    Timings timings;
    KinsolSolver solver(n * n * n, timings);
    Problem first = linear(n, Vector::Constant(n * n * n, 1)), second = linear(n, Vector::Constant(n * n * n, -3));
    Vector u = Vector::Zero(first.size());
    EXPECT_EQ(solver.solve(first, u, options_for(first)).factorisations, 1);
    EXPECT_EQ(solver.solve(second, u, options_for(second)).outcome, KinsolOutcome::converged);
    EXPECT_EQ(solver.factorisations(), 1);
    // new values under the same revision are not looked at: with half the tangent Newton goes to and fro
    Problem scaled = linear(n, Vector::Constant(n * n * n, 1));
    for (double& v : scaled.J.value) v *= 2;
    scaled.evaluate = [A = scaled.J](const Vector& at, VectorRef& F) {
        A.multiply(at.data(), F.data());
        F.array() -= 1;
        return Verdict::proceed;
    };
    u.setZero();
    EXPECT_EQ(solver.solve(scaled, u, options_for(scaled)).outcome, KinsolOutcome::max_iterations);
    EXPECT_EQ(solver.factorisations(), 1);
    // and with a new revision they are
    ++scaled.J.revision;
    u.setZero();
    EXPECT_EQ(solver.solve(scaled, u, options_for(scaled)).outcome, KinsolOutcome::converged);
    EXPECT_EQ(solver.factorisations(), 2);
    ++scaled.J.pattern;
    u.setZero();
    EXPECT_EQ(solver.solve(scaled, u, options_for(scaled)).factorisations, 1);
    EXPECT_GT(timings[Part::factor], 0);
    EXPECT_GT(timings[Part::solve], 0);
}

TEST(KinsolSolver, KeepsNoFactorOverAFailure) {
    const int n = 4;
    Timings timings;
    KinsolSolver solver(n * n * n, timings);
    const Problem good = linear(n, Vector::Ones(n * n * n));
    Problem p = good;
    Vector u = Vector::Zero(p.size());
    ASSERT_EQ(solver.solve(p, u, options_for(p)).outcome, KinsolOutcome::converged);
    const Vector solution = u;
    ++p.J.revision;
    diagonal(p.J, 7) = -1;
    u.setZero();
    ASSERT_EQ(solver.solve(p, u, options_for(p)).outcome, KinsolOutcome::singular);
    p.J = good.J; // its factors have been overwritten
    u.setZero();
    const KinsolResult again = solver.solve(p, u, options_for(p));
    EXPECT_EQ(again.outcome, KinsolOutcome::converged);
    EXPECT_EQ(again.factorisations, 1);
    EXPECT_EQ(u, solution);
}

TEST(KinsolSolver, ChangesBetweenSymmetricAndUnsymmetricTangents) {
    const int n = 5;
    Timings timings;
    KinsolSolver solver(n * n * n, timings);
    Problem p = linear(n, Vector::Constant(n * n * n, 1));
    Vector u = Vector::Zero(p.size()), v = u;
    EXPECT_EQ(solver.solve(p, u, options_for(p)).iterations, 1);
    p.J.symmetric_positive_definite = false;
    ++p.J.revision;
    EXPECT_EQ(solver.solve(p, v, options_for(p)).iterations, 1);
    EXPECT_EQ(solver.factorisations(), 2);
    const double round_off = 1e-12; // of displacements of order one
    EXPECT_LT((u - v).cwiseAbs().maxCoeff(), round_off);
}

/// The cubic problem, whose tangent solves by itself and keeps how far its solutions were allowed to be off.
struct Condensed : Problem, Tangent {
    explicit Condensed(Problem problem) : Problem(std::move(problem)) {}
    Tangent* tangent() override { return this; }
    void linearise() override { (void)jacobian(); }
    void multiply(const ConstVectorRef& x, VectorRef y) override { J.multiply(x.data(), y.data()); }
    [[nodiscard]] bool solves() const override { return true; }
    bool solve(const ConstVectorRef& b, VectorRef x, double allowed) override {
        asked.push_back(b.norm());
        allowances.push_back(allowed);
        if (inverse->factorise(J) != FactorStatus::ok) return false;
        inverse->solve(b.data(), x.data());
        return true;
    }

    std::unique_ptr<DirectSolver> inverse = make_cholesky();
    std::vector<double> asked, allowances; ///< |b| and |b - J x| allowed
};

/// Linear systems are solved to max(min(0.1 r, 1e-3) r, 0.1 tolerance), r = |b| * residual_scale, in units of b.
TEST(KinsolSolver, AsksForLinearSolutionsInTheUnitsOfTheResidual) {
    const int n = 4;
    for (const double scale : {1., 1024.}) {
        Condensed p(cubic(n, Vector::Constant(n * n * n, 10 / scale)));
        Vector u = Vector::Zero(p.size());
        KinsolOptions options = options_for(p);
        options.residual_scale = scale;
        EXPECT_EQ(run(p, u, options).outcome, KinsolOutcome::converged);
        ASSERT_GE(p.asked.size(), 2U);
        for (std::size_t k = 0; k < p.asked.size(); ++k) {
            const double r = p.asked[k] * scale, forcing = std::clamp(0.1 * r, 1e-8, 1e-3);
            EXPECT_DOUBLE_EQ(p.allowances[k] * scale, std::max(forcing * r, 0.1 * options.tolerance)) << scale;
        }
    }
}

/// One whose tangent knows a way of its own to solve, which never gets anywhere.
struct Hopeless : Preconditioned, Tangent {
    using Preconditioned::Preconditioned;
    Tangent* tangent() override { return this; }
    void linearise() override { (void)jacobian(); }
    void multiply(const ConstVectorRef& x, VectorRef y) override { J.multiply(x.data(), y.data()); }
    [[nodiscard]] bool solves() const override { return true; }
    bool solve(const ConstVectorRef&, VectorRef, double) override {
        ++tries;
        return false;
    }

    int tries = 0;
};

struct PreconditionedNewton : ::testing::Test {
    static constexpr int n = 12;
    Vector load = Vector::Constant(n * n * n, 10);
    KinsolOptions options;
    Timings timings;

    PreconditionedNewton() {
        options.unknown_scale = Vector::Ones(n * n * n);
        options.tolerance = 1e-10;
    }
    [[nodiscard]] Vector exact() {
        Problem direct = cubic(n, load);
        Vector u = Vector::Zero(direct.size());
        EXPECT_EQ(run(direct, u, options).outcome, KinsolOutcome::converged);
        return u;
    }
};

TEST_F(PreconditionedNewton, ConvergesQuadraticallyWithOneFactorisation) {
    Preconditioned p(cubic(n, load), laplacian(n, 3)); // the tangent's diagonal changes by up to 30
    Vector u = Vector::Zero(p.size());
    KinsolSolver solver(p.size(), timings);
    const KinsolResult result = solver.solve(p, u, options);
    EXPECT_EQ(result.outcome, KinsolOutcome::converged);
    EXPECT_EQ(result.factorisations, 1);
    const double round_off = 1e-12; // of residuals, forces of order ten
    for (std::size_t k = p.residuals.size() - 3; k < p.residuals.size(); ++k)
        EXPECT_LT(p.residuals[k], p.residuals[k - 1] * p.residuals[k - 1] + round_off);
    const double solved = 1e-10; // |u - exact| <= |F| / smallest eigenvalue, which is above one half
    EXPECT_LT((u - exact()).cwiseAbs().maxCoeff(), 2 * solved);
}

constexpr int tried = 2; // preconditioners that failed, then none in this solve

TEST_F(PreconditionedNewton, FactorisesTheTangentWhereThePreconditionerFails) {
    for (const double scale : {0.0, -1.0}) { // singular; indefinite
        Preconditioned p(cubic(n, load), laplacian(n));
        for (double& v : p.P.value) v *= scale;
        Vector u = Vector::Zero(p.size());
        KinsolSolver solver(p.size(), timings);
        const KinsolResult result = solver.solve(p, u, options);
        EXPECT_EQ(result.outcome, KinsolOutcome::converged);
        EXPECT_GT(result.iterations, tried);
        EXPECT_EQ(result.factorisations, result.iterations + tried);
        EXPECT_LT((u - exact()).cwiseAbs().maxCoeff(), 2 * options.tolerance);
    }
}

TEST_F(PreconditionedNewton, FactorisesTheTangentWhereGmresDoesNotConverge) {
    Preconditioned p(cubic(n, load), laplacian(n));
    osculate::support::Random random(7);
    std::fill(p.P.value.begin(), p.P.value.end(), 0.0);
    for (Index i = 0; i < p.size(); ++i) diagonal(p.P, i) = std::pow(10.0, random.uniform(-3, 3)); // nowhere near
    Vector u = Vector::Zero(p.size());
    KinsolSolver solver(p.size(), timings);
    const KinsolResult result = solver.solve(p, u, options);
    EXPECT_EQ(result.outcome, KinsolOutcome::converged);
    EXPECT_GT(result.iterations, tried);
    EXPECT_EQ(result.factorisations, result.iterations + tried);
}

TEST_F(PreconditionedNewton, SaysSoWhereTheTangentIsTooLargeToFactorise) {
    struct Large : Preconditioned {
        using Preconditioned::Preconditioned;
        [[nodiscard]] bool factorisable() const override { return false; }
    } p(cubic(n, load), laplacian(n));
    for (double& v : p.P.value) v = 0;
    Vector u = Vector::Zero(p.size());
    KinsolSolver solver(p.size(), timings);
    const KinsolResult result = solver.solve(p, u, options);
    EXPECT_EQ(result.outcome, KinsolOutcome::unsolved);
    EXPECT_TRUE(is_singular(result.outcome));
    EXPECT_EQ(u, Vector::Zero(p.size()));
}

/// Factors that may serve the next solve, for as many wasted iterations as `cost`.
struct Lasting : Preconditioned {
    using Preconditioned::Preconditioned;
    [[nodiscard]] bool lasts() const override { return true; }
    [[nodiscard]] double effort() const override { return cost; }
    FactorStatus refresh() override {
        ++refreshed;
        return Preconditioned::refresh();
    }
    double cost = 1e9;
    int refreshed = 0;
};

TEST_F(PreconditionedNewton, KeepsFactorsThatLastFromSolveToSolve) {
    Lasting p(cubic(n, load), laplacian(n, 3));
    KinsolSolver solver(p.size(), timings);
    for (const int expected : {1, 0}) {
        Vector u = Vector::Zero(p.size());
        const KinsolResult result = solver.solve(p, u, options);
        EXPECT_EQ(result.outcome, KinsolOutcome::converged);
        EXPECT_EQ(result.factorisations, expected);
        EXPECT_LT((u - exact()).cwiseAbs().maxCoeff(), 2 * options.tolerance);
    }
    EXPECT_GT(p.refreshed, 0);
    p.wear() = {}; // as a problem does whose matrix changes
    Vector u = Vector::Zero(p.size());
    EXPECT_EQ(solver.solve(p, u, options).factorisations, 1);
}

/// The more a factorisation costs, the longer factors are kept; and never beyond the iterations that they have wasted.
TEST_F(PreconditionedNewton, MakesFactorsAnewOnceTheirWasteWouldHavePaid) {
    int before = 1 << 30;
    for (const double cost : {0., 2., 1e9}) {
        Lasting p(cubic(n, 10 * load), laplacian(n, 3));
        p.cost = cost;
        Vector u = Vector::Zero(p.size());
        KinsolSolver solver(p.size(), timings);
        const KinsolResult result = solver.solve(p, u, options);
        EXPECT_EQ(result.outcome, KinsolOutcome::converged);
        EXPECT_LE(p.wear().usable ? p.wear().wasted : 0, cost);
        EXPECT_LE(result.factorisations, before);
        before = result.factorisations;
        EXPECT_TRUE(cost > 0 || result.factorisations > 1);
    }
    EXPECT_EQ(before, 1);
}

TEST_F(PreconditionedNewton, DoesNotRememberEarlierSolves) {
    const auto solve = [&](KinsolSolver& solver, double factor) {
        Preconditioned p(cubic(n, factor * load), laplacian(n, 3));
        Vector u = Vector::Zero(p.size());
        EXPECT_EQ(solver.solve(p, u, options).outcome, KinsolOutcome::converged);
        return u;
    };
    KinsolSolver used(n * n * n, timings), fresh(n * n * n, timings);
    (void)solve(used, 30);
    EXPECT_EQ(solve(used, 1), solve(fresh, 1)); // to the bit
}

TEST_F(PreconditionedNewton, GivesUpTheTangentsOwnWayForTheSolveAfterTwoFailures) {
    Hopeless p(cubic(n, load), laplacian(n, 3));
    KinsolSolver solver(p.size(), timings);
    for (int solve = 1; solve <= 3; ++solve) {
        Vector u = Vector::Zero(p.size());
        const KinsolResult result = solver.solve(p, u, options);
        EXPECT_EQ(result.outcome, KinsolOutcome::converged);
        ASSERT_GT(result.iterations, tried);
        EXPECT_EQ(p.tries, solve * tried) << "tries of all solves";
    }
}

TEST_F(PreconditionedNewton, SaysWhereTheTangentItselfIsSingular) {
    Preconditioned p(linear(n, load), laplacian(n));
    for (SparseMatrix* A : {&p.J, &p.P})
        for (SparseIndex i = 0; i < A->rows(); ++i)
            for (SparseIndex k = A->row_start[i]; k < A->row_start[i + 1]; ++k)
                if (i == 5 || A->column[k] == 5) A->value[k] = 0;
    Vector u = Vector::Zero(p.size());
    KinsolSolver solver(p.size(), timings);
    const KinsolResult result = solver.solve(p, u, options);
    EXPECT_EQ(result.outcome, KinsolOutcome::singular);
    EXPECT_EQ(result.failing_equation, 5); // from the Cholesky factorisation of P: LU does not tell
    EXPECT_TRUE(u.allFinite());
}

} // namespace
} // namespace osculate::solve::OSCULATE_THIS_FILE
