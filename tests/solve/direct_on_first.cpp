#include "osculate/solve/direct_on_first.hpp"

#include "support/thread_ranks.hpp"
#include "systems.hpp"

#include <gtest/gtest.h>

namespace osculate::solve::OSCULATE_THIS_FILE {
namespace {

using namespace fixtures;
using osculate::support::Random;

TEST(DirectOnFirst, GivesAllProcessesTheBitsOfOne) {
    Random random(7);
    const Matrix A = random_matrix(40, 3, random);
    const SparseMatrix S = sparse(A, false);
    const Vector b = random_vector(40, random);
    const auto alone = make_lu();
    ASSERT_EQ(alone->factorise(S), FactorStatus::ok);
    Vector expected(40);
    alone->solve(b.data(), expected.data());
    constexpr int count = 3;
    std::vector<Vector> found(count, Vector::Zero(40));
    std::vector<FactorStatus> status(count, FactorStatus::singular);
    osculate::support::on_ranks(count, [&](const std::shared_ptr<Ranks>& ranks) {
        const auto rank = static_cast<std::size_t>(ranks->rank());
        // only the first has the right matrix: the others must not use theirs
        SparseMatrix own = S;
        if (rank > 0) std::ranges::fill(own.value, 0);
        const auto solver = make_direct_on_first(make_lu(), *ranks);
        status[rank] = solver->factorise(own);
        solver->solve(b.data(), found[rank].data());
    });
    for (std::size_t rank = 0; rank < count; ++rank) {
        EXPECT_EQ(status[rank], FactorStatus::ok);
        EXPECT_EQ(found[rank], expected);
    }
}

TEST(DirectOnFirst, TellsAllProcessesWhichEquationFails) {
    Matrix A = Matrix::Identity(5, 5);
    A(3, 3) = 0;
    const SparseMatrix S = sparse(A, false);
    const auto alone = make_lu();
    const FactorStatus expected = alone->factorise(S);
    ASSERT_NE(expected, FactorStatus::ok);
    osculate::support::on_ranks(2, [&](const std::shared_ptr<Ranks>& ranks) {
        const auto solver = make_direct_on_first(make_lu(), *ranks);
        EXPECT_EQ(solver->factorise(S), expected);
        EXPECT_EQ(solver->failing_equation(), alone->failing_equation());
    });
}

} // namespace
} // namespace osculate::solve::OSCULATE_THIS_FILE
