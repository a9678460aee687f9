#include "osculate/solve/direct_solver.hpp"

#include "systems.hpp"

#include <gtest/gtest.h>

namespace osculate::solve::OSCULATE_THIS_FILE {
namespace {

using namespace fixtures;
using osculate::support::Random;

constexpr double backward_error = 1e-14; // of a stable factorisation of a hundred rows: a few machine epsilons

/// |A x - b| / (|A| |x| + |b|), largest entries.
double residual(const Matrix& A, const Vector& x, const Vector& b) {
    return (A * x - b).cwiseAbs().maxCoeff() /
           (A.cwiseAbs().rowwise().sum().maxCoeff() * x.cwiseAbs().maxCoeff() + b.cwiseAbs().maxCoeff());
}

Vector solution(DirectSolver& solver, const Vector& b) {
    Vector x = Vector::Constant(b.size(), std::nan(""));
    solver.solve(b.data(), x.data());
    return x;
}

TEST(SparseMatrix, MultipliesLikeItsDenseTwin) {
    Random random(41);
    const Matrix A = random_matrix(60, 0, random);
    const SparseMatrix S = sparse(A, false);
    EXPECT_EQ(S.rows(), 60);
    EXPECT_EQ(S.nonzeros(), static_cast<SparseIndex>(S.value.size()));
    const Vector x = random_vector(60, random);
    Vector y = Vector::Constant(60, 7);
    S.multiply(x.data(), y.data());
    EXPECT_LT((y - A * x).cwiseAbs().maxCoeff(), backward_error);
}

TEST(SparseMatrix, IsEmptyAtFirst) {
    EXPECT_EQ(SparseMatrix{}.rows(), 0);
    EXPECT_EQ(SparseMatrix{}.nonzeros(), 0);
}

TEST(Cholesky, SolvesSymmetricPositiveDefiniteSystems) {
    Random random(42);
    const auto solver = make_cholesky();
    for (const Index n : {1, 2, 17, 100}) {
        const Matrix B = random_matrix(n, 0.5, random);
        const Matrix A = B * B.transpose() + 0.01 * Matrix::Identity(n, n);
        const SparseMatrix S = sparse(A, true, static_cast<std::uint64_t>(n));
        ASSERT_EQ(solver->factorise(S), FactorStatus::ok);
        EXPECT_EQ(solver->failing_equation(), -1);
        for (int k = 0; k < 3; ++k) {
            const Vector b = random_vector(n, random);
            EXPECT_LT(residual(A, solution(*solver, b), b), backward_error);
        }
    }
}

TEST(Lu, SolvesUnsymmetricSystems) {
    Random random(43);
    const auto solver = make_lu();
    for (const Index n : {1, 2, 17, 100}) {
        const Matrix A = random_matrix(n, 1, random);
        const SparseMatrix S = sparse(A, false, static_cast<std::uint64_t>(n));
        ASSERT_EQ(solver->factorise(S), FactorStatus::ok);
        for (int k = 0; k < 3; ++k) {
            const Vector b = random_vector(n, random);
            EXPECT_LT(residual(A, solution(*solver, b), b), backward_error);
        }
    }
}

TEST(Lu, SolvesIndefiniteSystemsWithZerosOnTheDiagonal) {
    Random random(44);
    const Index n = 40, m = 10;
    Matrix A = Matrix::Zero(n + m, n + m); // a saddle point, as of multipliers
    const Matrix B = random_matrix(n, 1, random);
    A.topLeftCorner(n, n) = B * B.transpose();
    for (Index k = 0; k < m; ++k) A(n + k, 3 * k) = A(3 * k, n + k) = 1;
    const auto solver = make_lu();
    const SparseMatrix S = sparse(A, false);
    ASSERT_EQ(solver->factorise(S), FactorStatus::ok);
    const Vector b = random_vector(n + m, random);
    EXPECT_LT(residual(A, solution(*solver, b), b), backward_error);
}

TEST(Cholesky, NamesTheEquationOfANegativePivot) {
    SparseMatrix A = laplacian(5);
    diagonal(A, 77) = -1;
    const auto solver = make_cholesky();
    EXPECT_EQ(solver->factorise(A), FactorStatus::indefinite);
    // the negative pivot shows at the latest of the row and its neighbours in elimination order
    const SparseIndex at = solver->failing_equation();
    EXPECT_GE(at, 0);
    bool near = false;
    for (SparseIndex k = A.row_start[77]; k < A.row_start[78]; ++k) near = near || A.column[k] == at;
    EXPECT_TRUE(near) << at;
}

TEST(Cholesky, NamesAnEquationThatNothingHolds) {
    Matrix A = Matrix::Identity(9, 9);
    A(4, 4) = 0;
    const auto solver = make_cholesky();
    EXPECT_NE(solver->factorise(sparse(A, true)), FactorStatus::ok);
    EXPECT_EQ(solver->failing_equation(), 4);
}

TEST(Cholesky, ReportsABodyThatNothingHolds) {
    const int n = 6; // Laplacian with row sums zero: a free body
    SparseMatrix A = laplacian(n);
    for (SparseIndex i = 0; i < A.rows(); ++i)
        diagonal(A, i) = static_cast<double>(A.row_start[i + 1] - A.row_start[i] - 1);
    EXPECT_NE(make_cholesky()->factorise(A), FactorStatus::ok);
}

TEST(Cholesky, SolvesAgainAfterAFailure) {
    SparseMatrix A = laplacian(5);
    const auto solver = make_cholesky();
    diagonal(A, 7) = -1;
    EXPECT_EQ(solver->factorise(A), FactorStatus::indefinite);
    diagonal(A, 7) = 6;
    ++A.revision;
    ASSERT_EQ(solver->factorise(A), FactorStatus::ok);
    EXPECT_EQ(solver->failing_equation(), -1);
    Vector x = Vector::LinSpaced(125, 0, 1), b(125);
    A.multiply(x.data(), b.data());
    const double forward_error = 1e-12; // condition of about 20
    EXPECT_LT((solution(*solver, b) - x).cwiseAbs().maxCoeff(), forward_error);
}

TEST(Lu, ReportsSingularMatrices) {
    Random random(45);
    Matrix A = random_matrix(30, 1, random);
    const auto solver = make_lu();
    ASSERT_EQ(solver->factorise(sparse(A, false)), FactorStatus::ok);
    Matrix zero_row = A;
    zero_row.row(11).setZero();
    EXPECT_EQ(solver->factorise(sparse(zero_row, false, 2)), FactorStatus::singular);
    Matrix twin_rows = A;
    twin_rows.row(11) = twin_rows.row(23);
    EXPECT_EQ(solver->factorise(sparse(twin_rows, false, 3)), FactorStatus::singular);
}

/// New values in the old pattern, then a new pattern: an old analysis or old values would give the old answer.
void expect_fresh_factors(DirectSolver& solver, bool symmetric) {
    Random random(46);
    Matrix A = random_matrix(50, 8, random);
    A = (A + A.transpose()).eval();
    SparseMatrix S = sparse(A, symmetric);
    const Vector b = random_vector(50, random);
    ASSERT_EQ(solver.factorise(S), FactorStatus::ok);
    EXPECT_LT(residual(A, solution(solver, b), b), backward_error);
    for (double& v : S.value) v *= 2;
    ++S.revision;
    ASSERT_EQ(solver.factorise(S), FactorStatus::ok);
    EXPECT_LT(residual(2 * A, solution(solver, b), b), backward_error);
    Matrix other = random_matrix(80, 8, random);
    other = (other + other.transpose()).eval();
    const SparseMatrix T = sparse(other, symmetric, 2);
    const Vector c = random_vector(80, random);
    ASSERT_EQ(solver.factorise(T), FactorStatus::ok);
    EXPECT_LT(residual(other, solution(solver, c), c), backward_error);
}

TEST(Cholesky, FollowsNewValuesAndNewPatterns) {
    expect_fresh_factors(*make_cholesky(), true);
}

TEST(Lu, FollowsNewValuesAndNewPatterns) {
    expect_fresh_factors(*make_lu(), false);
}

} // namespace
} // namespace osculate::solve::OSCULATE_THIS_FILE
