#include "osculate/linear/mass_iteration.hpp"

#include "block_systems.hpp"

#include <Eigen/Cholesky>
#include <gtest/gtest.h>

namespace osculate::linear::OSCULATE_THIS_FILE {
namespace {

using namespace fixtures;
using osculate::support::Random;

/// Masses and couplings of elements, a node held along a slanted direction, node 8 without mass.
struct MassIteration : ::testing::Test {
    Random random{17};
    BlockMatrix M{9, some_elements()};
    Constraints constraints{9, {{1, Vec3(1, 2, 2) / 3, 0, false, false, 0}, {6, Vec3::UnitX(), 0, false, false, 0}}};

    void add(double smallest) {
        for (const auto& element : some_elements()) {
            const auto n = 3 * static_cast<Index>(element.size());
            const Matrix A = random_matrix(n, random);
            M.add(element, A * A.transpose() + smallest * Matrix::Identity(n, n));
        }
    }
    /// Over the free components, from its definition: column by column.
    [[nodiscard]] Matrix over_free_components() const {
        Matrix result(constraints.equations(), constraints.equations());
        for (Index e = 0; e < result.cols(); ++e) {
            Field u(9), f(9);
            constraints.scatter(Vector::Unit(result.rows(), e), Field(9), u);
            M.multiply_add(u, f, 1);
            Vector column(result.rows());
            constraints.gather(f, column);
            result.col(e) = column;
        }
        return result;
    }
};

TEST_F(MassIteration, SolvesAsFactorsDo) {
    add(1);
    Vector f(constraints.equations());
    for (double& value : f) value = random.uniform();
    Matrix dense = over_free_components();
    for (int k = 0; k < 3; ++k) dense(constraints.equation(8, k), constraints.equation(8, k)) = 1;
    Vector expected = dense.llt().solve(f);
    for (int k = 0; k < 3; ++k) expected(constraints.equation(8, k)) = 0;
    for (const int threads : {1, 2}) {
        const auto a = iterate_by_mass(M, constraints, f, threads);
        ASSERT_TRUE(a);
        EXPECT_LT((*a - expected).norm(), 1e-12 * expected.norm());
    }
}

TEST_F(MassIteration, GivesNothingForMassesBelowZero) {
    add(-100);
    EXPECT_FALSE(iterate_by_mass(M, constraints, Vector::Ones(constraints.equations()), 1));
}

TEST_F(MassIteration, LeavesAtRestWhatNothingActsOn) {
    add(1);
    const auto a = iterate_by_mass(M, constraints, Vector::Zero(constraints.equations()), 1);
    ASSERT_TRUE(a);
    EXPECT_TRUE(a->isZero(0));
}

} // namespace
} // namespace osculate::linear::OSCULATE_THIS_FILE
