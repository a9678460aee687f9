/// Inverses on some of the unknowns, dense factors, GMRES on its own.

#include "every_nth.hpp"
#include "osculate/solve/dense_lu.hpp"
#include "osculate/solve/direct_solver.hpp"
#include "osculate/solve/gmres.hpp"
#include "support/thread_ranks.hpp"
#include "systems.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <gtest/gtest.h>
#include <limits>
#include <numeric>

namespace osculate::solve::OSCULATE_THIS_FILE {
namespace {

using namespace fixtures;
using osculate::support::Random;

constexpr double epsilon = std::numeric_limits<double>::epsilon();

Matrix dense(const SparseMatrix& S) {
    Matrix A = Matrix::Zero(S.rows(), S.rows());
    for (SparseIndex i = 0; i < S.rows(); ++i)
        for (auto k = S.row_start[i]; k < S.row_start[i + 1]; ++k) A(i, S.column[k]) = S.value[k];
    return A;
}

/// Largest difference to the inverse by dense LU, of its largest entry.
double error_of_compliance(const SparseMatrix& S, const std::vector<SparseIndex>& kept) {
    const auto solver = make_condensing_cholesky(kept);
    EXPECT_EQ(solver->factorise(S), FactorStatus::ok);
    const Matrix W = solver->compliance(), inverse = dense(S).inverse();
    double worst = 0;
    for (std::size_t i = 0; i < kept.size(); ++i)
        for (std::size_t j = 0; j < kept.size(); ++j)
            worst =
                std::max(worst, std::abs(W(static_cast<Index>(i), static_cast<Index>(j)) - inverse(kept[i], kept[j])));
    EXPECT_EQ(W, Matrix(W.transpose()));
    const Vector b = Vector::LinSpaced(S.rows(), -1, 2);
    Vector x(b.size());
    solver->solve(b.data(), x.data());
    EXPECT_LT((dense(S) * x - b).cwiseAbs().maxCoeff(), 1e3 * epsilon);
    return worst / inverse.cwiseAbs().maxCoeff();
}

constexpr int side = 7;
/// The condition number of a Laplacian of n^3 points is about n^2.
constexpr double round_off = 10 * epsilon * side * side;

TEST(CondensingCholesky, InvertsOnTheKeptUnknownsInTheirOrder) {
    const SparseMatrix S = laplacian(side);
    std::vector<SparseIndex> bottom(side * side);
    std::iota(bottom.begin(), bottom.end(), 0);
    EXPECT_LT(error_of_compliance(S, bottom), round_off);
    std::reverse(bottom.begin(), bottom.end());
    EXPECT_LT(error_of_compliance(S, bottom), round_off);
    EXPECT_LT(error_of_compliance(S, {5, 340, 0, 171}), round_off);
}

TEST(CondensingCholesky, InvertsWhereEverythingIsKept) {
    const SparseMatrix S = laplacian(3);
    std::vector<SparseIndex> all(27);
    std::iota(all.begin(), all.end(), 0);
    EXPECT_LT(error_of_compliance(S, all), round_off);
}

TEST(CondensingCholesky, InvertsWherePartsDoNotTouch) {
    // two copies side by side: no order of elimination has both their kept unknowns last
    const Matrix one = dense(laplacian(3));
    Matrix two = Matrix::Zero(54, 54);
    two.topLeftCorner(27, 27) = two.bottomRightCorner(27, 27) = one;
    EXPECT_LT(error_of_compliance(sparse(two, true), {0, 13, 27, 50}), round_off);
}

TEST(CondensingCholesky, FollowsNewValues) {
    const auto solver = make_condensing_cholesky({0, 26});
    for (const double shift : {0.0, 1.0}) {
        const SparseMatrix S = laplacian(3, shift);
        ASSERT_EQ(solver->factorise(S), FactorStatus::ok);
        EXPECT_NEAR(solver->compliance()(0, 1), dense(S).inverse()(0, 26), round_off);
    }
}

/// The same in single precision, for 12^3 points.
constexpr double single_round_off = 10 * std::numeric_limits<float>::epsilon() * 12 * 12;

/// Largest difference between solve_selected() and the same solution by solve(), of its largest entry.
double error_of_selection(CondensingSolver& solver, Index size, const std::vector<SparseIndex>& chosen) {
    Random random(3);
    const Vector right = random_vector(static_cast<Index>(chosen.size()), random);
    Vector b = Vector::Zero(size), x(size), at(right.size());
    for (std::size_t i = 0; i < chosen.size(); ++i) b(chosen[i]) = right(static_cast<Index>(i));
    solver.solve(b.data(), x.data());
    solver.select(chosen);
    solver.solve_selected(right.data(), at.data());
    double worst = 0;
    for (std::size_t i = 0; i < chosen.size(); ++i)
        worst = std::max(worst, std::abs(at(static_cast<Index>(i)) - x(chosen[i])));
    return worst / x.cwiseAbs().maxCoeff();
}

TEST(CondensingCholesky, SolvesAtChosenEquationsAsInFull) {
    constexpr int wide = 12;
    const SparseMatrix S = laplacian(wide);
    const auto solver = make_condensing_cholesky({});
    ASSERT_EQ(solver->factorise(S), FactorStatus::ok);
    std::vector<SparseIndex> bottom(wide * wide), all(static_cast<std::size_t>(S.rows()));
    std::iota(bottom.begin(), bottom.end(), 0);
    std::iota(all.begin(), all.end(), 0);
    std::reverse(all.begin(), all.end());
    for (const auto& chosen : {bottom, {1000, 5, 171}, {1727}, all, bottom})
        EXPECT_LT(error_of_selection(*solver, S.rows(), chosen), single_round_off) << chosen.size() << " equations";
}

TEST(CondensingCholesky, SolvesAtChosenEquationsWithNewValuesAndPatterns) {
    const auto solver = make_condensing_cholesky({});
    for (const auto& [points, shift] : {std::pair{3, 0.0}, {3, 1.0}, {5, 0.0}, {5, 2.0}}) {
        SparseMatrix S = laplacian(points, shift);
        S.pattern = static_cast<std::uint64_t>(points);
        ASSERT_EQ(solver->factorise(S), FactorStatus::ok);
        EXPECT_LT(error_of_selection(*solver, S.rows(), {0, 4, 26}), single_round_off)
            << points << " points, shift " << shift;
    }
}

TEST(DenseLu, SolvesAndSaysWhatIsSingular) {
    Random random(7);
    Matrix A = random_matrix(40, 1, random);
    const Vector b = random_vector(40, random);
    Vector x = b;
    DenseLu lu;
    ASSERT_TRUE(lu.factorise(A));
    lu.solve(x.data());
    EXPECT_LT((A * x - b).norm(), 1e3 * epsilon * A.norm() * x.norm());
    A.row(3) = A.row(17) + A.row(20);
    EXPECT_FALSE(lu.factorise(A));
    EXPECT_TRUE(lu.factorise(Matrix(0, 0)));
}

TEST(Gmres, SolvesAsFarAsAskedAndSaysWhereItCannot) {
    Random random(8);
    const Matrix A = random_matrix(50, 4, random);
    const Vector b = random_vector(50, random);
    const auto times = [&](const double* x, double* y) {
        Eigen::Map<Vector>(y, 50) = A * Eigen::Map<const Vector>(x, 50);
    };
    const Matrix M = A.inverse();
    const auto inverse = [&](const double* x, double* y) {
        Eigen::Map<Vector>(y, 50) = M * Eigen::Map<const Vector>(x, 50);
    };
    Gmres gmres(50);
    for (const double tolerance : {1e-3, 1e-9}) {
        Vector x(50);
        EXPECT_TRUE(gmres.solve(times, {}, b.data(), x.data(), tolerance).converged);
        EXPECT_LE((A * x - b).norm(), 1.01 * tolerance);
        const auto result = gmres.solve(times, inverse, b.data(), x.data(), tolerance);
        EXPECT_TRUE(result.converged);
        EXPECT_EQ(result.iterations, 1);
        EXPECT_LE((A * x - b).norm(), 1.01 * tolerance);
    }
    const auto rotation = [](const double* x, double* y) { // Krylov spaces reach nothing before the last
        for (int i = 0; i < 100; ++i) y[(i + 1) % 100] = x[i];
    };
    Vector e = Vector::Unit(100, 0), x(100);
    EXPECT_FALSE(Gmres(100).solve(rotation, {}, e.data(), x.data(), 1e-3).converged);
}

TEST(Gmres, HasTheSameBitsForAnyNumberOfThreads) {
    const Index n = 50'001;
    Random random(10);
    const Vector b = random_vector(n, random);
    const auto times = [](const double* x, double* y) {
        for (Index i = 0; i < n; ++i) y[i] = 3 * x[i] - (i > 0 ? x[i - 1] : 0) - (i + 1 < n ? 1.5 * x[i + 1] : 0);
    };
    Vector alone(n), Ax(n);
    const auto expected = Gmres(n).solve(times, {}, b.data(), alone.data(), 1e-6);
    ASSERT_TRUE(expected.converged);
    EXPECT_GT(expected.iterations, 10);
    times(alone.data(), Ax.data());
    EXPECT_LE((Ax - b).norm(), 1.01e-6);
    for (const int threads : {2, 3, 8}) {
        Vector x(n);
        EXPECT_EQ(Gmres(n, nullptr, threads).solve(times, {}, b.data(), x.data(), 1e-6).iterations,
                  expected.iterations);
        EXPECT_EQ(x, alone) << threads << " threads";
    }
}

TEST(Gmres, SharesItsDirectionsAmongProcesses) {
    Random random(9);
    const Matrix A = random_matrix(50, 4, random), M = Matrix(A.diagonal().cwiseInverse().asDiagonal());
    const Vector b = random_vector(50, random);
    const auto by = [](const Matrix& matrix) {
        return [&matrix](const double* x, double* y) {
            Eigen::Map<Vector>(y, 50) = matrix * Eigen::Map<const Vector>(x, 50);
        };
    };
    Vector alone(50);
    const auto expected = Gmres(50).solve(by(A), by(M), b.data(), alone.data(), 1e-9);
    ASSERT_TRUE(expected.converged);
    const auto own_alone = [](const LinearMap& map, const Slices& slices) -> LinearMap {
        return [&map, &slices](const double* x, double* y) {
            Vector all(50);
            map(x, all.data());
            Eigen::Map<Vector>(y, 50).setConstant(1e300);
            for (const Index i : slices.own()) y[i] = all(i);
        };
    };
    for (const int count : {1, 3, 60}) { // more processes than numbers, too
        std::vector<Vector> found(static_cast<std::size_t>(count), Vector::Zero(50));
        osculate::support::on_ranks(count, [&](const std::shared_ptr<Ranks>& ranks) {
            Vector& x = found[static_cast<std::size_t>(ranks->rank())];
            EveryNth slices(*ranks, 50);
            const LinearMap times = by(A), nearly = by(M);
            std::vector<double> in(50), out(50), right, slice(slices.own().size());
            for (const Index i : slices.own()) right.push_back(b(i));
            Gmres gmres(50, &slices);
            gmres.lend(in.data(), out.data());
            const auto result =
                gmres.solve(own_alone(times, slices), own_alone(nearly, slices), right.data(), slice.data(), 1e-9);
            slices.gather(slice, x.data());
            EXPECT_TRUE(result.converged);
            EXPECT_NEAR(result.iterations, expected.iterations, 1);
        });
        for (const Vector& x : found) {
            EXPECT_EQ(x, found.front());
            EXPECT_LE((A * x - b).norm(), 1.01e-9);
        }
    }
}

} // namespace
} // namespace osculate::solve::OSCULATE_THIS_FILE
