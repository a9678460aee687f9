#include "osculate/solve/by_components.hpp"

#include "systems.hpp"

#include <gtest/gtest.h>

namespace osculate::solve::OSCULATE_THIS_FILE {
namespace {

using namespace fixtures;
using osculate::support::Random;

/// Three blocks whose rows alternate: equation e is row e/3 of block e%3.
Matrix alternating(const std::array<Matrix, 3>& blocks) {
    const Index n = blocks[0].rows();
    Matrix A = Matrix::Zero(3 * n, 3 * n);
    for (Index k = 0; k < 3; ++k)
        for (Index i = 0; i < n; ++i)
            for (Index j = 0; j < n; ++j) A(3 * i + k, 3 * j + k) = blocks[static_cast<std::size_t>(k)](i, j);
    return A;
}

Matrix chain(Index n, double diagonal, double below) {
    Matrix A = diagonal * Matrix::Identity(n, n);
    for (Index i = 1; i < n; ++i) {
        A(i, i - 1) = below;
        A(i - 1, i) = -1;
    }
    return A;
}

TEST(ByComponents, SolvesWhatTheWholeMatrixSays) {
    Random random(3);
    for (const bool symmetric : {true, false}) {
        const double below = symmetric ? -1 : -0.3;
        const Matrix A = alternating({chain(8, 3, below), chain(8, 4, below), chain(8, 2.5, below)});
        const SparseMatrix S = sparse(A, symmetric);
        const auto solver = make_by_components(symmetric ? make_cholesky : make_lu);
        ASSERT_EQ(solver->factorise(S), FactorStatus::ok);
        const Vector b = random_vector(24, random);
        Vector x(24);
        solver->solve(b.data(), x.data());
        EXPECT_LT((A * x - b).norm(), 1e-13);
        Matrix B = Matrix::Zero(24, 4), X;
        for (Index k = 0; k < 3; ++k) B.col(k)(3 + k) = 1; // each loads one block
        B.col(3) = b;
        solver->solve(B, X);
        EXPECT_LT((A * X - B).norm(), 1e-13);
        for (Index e = 0; e < 24; ++e) EXPECT_TRUE(e % 3 == 0 || X(e, 0) == 0) << "a block that carries no load";
    }
}

TEST(ByComponents, TakesOverOtherValuesAndPatterns) {
    const auto solver = make_by_components(make_cholesky);
    const Vector ones = Vector::Ones(24);
    Vector x(24);
    SparseMatrix S = sparse(alternating({chain(8, 3, -1), chain(8, 3, -1), chain(8, 3, -1)}), true);
    ASSERT_EQ(solver->factorise(S), FactorStatus::ok);
    for (double& value : S.value) value *= 2;
    ++S.revision;
    ASSERT_EQ(solver->factorise(S), FactorStatus::ok);
    solver->solve(ones.data(), x.data());
    Vector product(24);
    S.multiply(x.data(), product.data());
    EXPECT_LT((product - ones).norm(), 1e-13);
    const SparseMatrix one = sparse(chain(24, 3, -1), true, 2);
    ASSERT_EQ(solver->factorise(one), FactorStatus::ok);
    solver->solve(ones.data(), x.data());
    one.multiply(x.data(), product.data());
    EXPECT_LT((product - ones).norm(), 1e-13);
}

TEST(ByComponents, NamesTheEquationThatFails) {
    Matrix loose = chain(8, 2, -1);
    loose(0, 0) = loose(7, 7) = 1; // a chain that nothing holds
    const SparseMatrix S = sparse(alternating({chain(8, 3, -1), loose, chain(8, 3, -1)}), true);
    const auto solver = make_by_components(make_cholesky);
    EXPECT_NE(solver->factorise(S), FactorStatus::ok);
    EXPECT_EQ(solver->failing_equation() % 3, 1);
}

} // namespace
} // namespace osculate::solve::OSCULATE_THIS_FILE
