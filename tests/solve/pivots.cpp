/// What counts as singular: bodies that nothing holds do, whatever the units and whatever is beside them, and no others.

#include "osculate/solve/direct_solver.hpp"
#include "systems.hpp"

#include <gtest/gtest.h>

namespace osculate::solve::OSCULATE_THIS_FILE {
namespace {

using namespace fixtures;
using osculate::support::Random;

constexpr int side = 4;
constexpr Index nodes = Index{side} * side * side; ///< of a body: one unknown each

/// Springs of random stiffness, `stiffness` times 0.5 to 1.5, along the edges of a grid of nodes; a held body has one more
/// from every node of its lowest layer to the ground. Diagonals are sums: those of a floating body cancel up to round-off.
Matrix springs(double stiffness, bool held, Random& random) {
    Matrix K = Matrix::Zero(nodes, nodes);
    const auto connect = [&](Index i, Index j) {
        const double k = stiffness * (1 + 0.5 * random.uniform());
        K(i, i) += k;
        if (j < 0) return;
        K(j, j) += k;
        K(i, j) -= k;
        K(j, i) -= k;
    };
    for (Index i = 0; i < nodes; ++i) {
        if (i % side + 1 < side) connect(i, i + 1);
        if (i / side % side + 1 < side) connect(i, i + side);
        if (i / (side * side) + 1 < side) connect(i, i + Index{side} * side);
        if (held && i < side * side) connect(i, -1);
    }
    return K;
}

/// Two bodies beside each other.
Matrix beside(const Matrix& a, const Matrix& b) {
    Matrix K = Matrix::Zero(a.rows() + b.rows(), a.cols() + b.cols());
    K.topLeftCorner(a.rows(), a.cols()) = a;
    K.bottomRightCorner(b.rows(), b.cols()) = b;
    return K;
}

/// Forces of some other unit.
constexpr double units[] = {1e-9, 1, 1e9};
constexpr double far_stiffer =
    1e15; ///< what is left of the softer body's pivots would be round-off of the stiffer one's

class Pivots : public ::testing::TestWithParam<bool> {
protected:
    static std::unique_ptr<DirectSolver> make() { return GetParam() ? make_cholesky() : make_lu(); }
    static SparseMatrix matrix(const Matrix& K) { return sparse(K, GetParam()); }
};

TEST_P(Pivots, OfASoftBodyBesideAStiffOneAreNoReasonToCallItSingular) {
    Random random(51);
    for (const double unit : units)
        for (const double ratio : {far_stiffer, 1 / far_stiffer}) {
            Matrix K = beside(springs(unit, true, random), springs(unit * ratio, true, random));
            EXPECT_EQ(make()->factorise(matrix(K)), FactorStatus::ok) << ratio << " at " << unit;
            // the second stands on the first, where that is the stiff one
            if (ratio > 1) continue;
            for (Index i = 0; i < side * side; ++i) {
                const Index top = nodes - side * side + i, foot = nodes + i;
                K(top, top) += unit * ratio;
                K(top, foot) = K(foot, top) = -unit * ratio;
            }
            const auto solver = make();
            EXPECT_EQ(solver->factorise(matrix(K)), FactorStatus::ok) << ratio << " at " << unit << ", standing";
            EXPECT_EQ(solver->failing_equation(), -1);
        }
}

TEST_P(Pivots, OfAFloatingBodyMakeItSingularAndNameAnUnknownOfThatBody) {
    Random random(52);
    for (const double unit : units)
        for (const double ratio : {far_stiffer, 1.0, 1 / far_stiffer})
            for (const bool first : {true, false}) {
                const Matrix floating = springs(unit * ratio, false, random), held = springs(unit, true, random);
                const auto solver = make();
                EXPECT_NE(solver->factorise(matrix(first ? beside(floating, held) : beside(held, floating))),
                          FactorStatus::ok)
                    << ratio << " at " << unit;
                const SparseIndex at = solver->failing_equation();
                ASSERT_GE(at, 0);
                ASSERT_LT(at, 2 * nodes);
                EXPECT_EQ(at < nodes, first) << "unknown " << at << ", " << ratio << " at " << unit;
            }
}

INSTANTIATE_TEST_SUITE_P(Of, Pivots, ::testing::Bool(),
                         [](const auto& test) { return test.param ? "Cholesky" : "Lu"; });

/// As the rows of contact and equilibrium do: what is named must be the unknown, not the row.
TEST(Lu, NamesTheUnknownWhereRowsHaveTradedPlaces) {
    Random random(53);
    const Matrix K = beside(springs(1, false, random), springs(1, true, random));
    Matrix exchanged(2 * nodes, 2 * nodes);
    exchanged << K.bottomRows(nodes), K.topRows(nodes);
    const auto solver = make_lu();
    ASSERT_EQ(solver->factorise(sparse(exchanged, false)), FactorStatus::singular);
    EXPECT_GE(solver->failing_equation(), 0);
    EXPECT_LT(solver->failing_equation(), nodes);
}

TEST(Cholesky, OfAMatrixWithoutEquationsHasNothingToDo) {
    SparseMatrix empty;
    empty.symmetric_positive_definite = true;
    const auto solver = make_cholesky();
    ASSERT_EQ(solver->factorise(empty), FactorStatus::ok);
    EXPECT_EQ(solver->failing_equation(), -1);
    double untouched = 7;
    solver->solve(&untouched, &untouched);
    EXPECT_EQ(untouched, 7);
    // and goes on with others
    ASSERT_EQ(solver->factorise(laplacian(3)), FactorStatus::ok);
    Vector b = Vector::Ones(27), x = Vector::Zero(27);
    solver->solve(b.data(), x.data());
    EXPECT_GT(x.minCoeff(), 0);
}

} // namespace
} // namespace osculate::solve::OSCULATE_THIS_FILE
