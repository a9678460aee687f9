#include "osculate/linear/system_matrix.hpp"

#include "block_systems.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <numeric>

namespace osculate::linear::OSCULATE_THIS_FILE {
namespace {

using namespace fixtures;
using osculate::support::Random;

constexpr double round_off = 1e-14; // sums of a few products of order one
constexpr Index nodes = 14;

/// Two bodies, nodes 0-5 (the slaves among them) and 6-13.
BlockMatrix stiffness() {
    const std::vector<std::vector<Index>> elements{
        {0, 1, 2, 3}, {2, 3, 4, 5}, {6, 7, 8, 9}, {8, 9, 10, 11}, {11, 12, 13}};
    Random random(71);
    BlockMatrix K(nodes, elements);
    for (const auto& element : elements) {
        const Matrix A = random_matrix(3 * static_cast<Index>(element.size()), random);
        K.add(element, A * A.transpose());
    }
    return K;
}

NodeConstraint hold(Index node, const Vec3& direction) {
    NodeConstraint c;
    c.node = node;
    c.direction = direction;
    return c;
}

/// Slaves 2 (fixed), 4 (one component held), 5 (turned, two held), 1 (turned, one held); masters 7 and 9 held in part.
Constraints supports() {
    const Vec3 slant(0.6, 0, 0.8), across(-0.8, 0, 0.6);
    return {nodes,
            {hold(2, Vec3::UnitX()), hold(2, Vec3::UnitY()), hold(2, Vec3::UnitZ()), hold(4, Vec3::UnitY()),
             hold(5, slant), hold(5, Vec3::UnitY()), hold(1, across), hold(7, Vec3::UnitZ()), hold(9, slant),
             hold(12, Vec3::UnitX()), hold(12, Vec3::UnitY()), hold(12, Vec3::UnitZ())}};
}

/// Node 3 is a slave of two pairs, node 4 slave of one pair and master of another, node 0 open without a partner.
std::vector<Coupling> couplings() {
    return {{3, {6, 7, 8, 9}}, {4, {6, 7}}, {5, {4, 8, 9, 12}}, {2, {10, 11}}, {1, {9, 10}},
            {3, {10, 11, 13}}, {0, {}}};
}

class WithContact : public ::testing::Test {
protected:
    const BlockMatrix K = stiffness();
    const Constraints constraints = supports();
    SystemMatrix system{constraints, K, couplings()};

    /// Columns: every displacement unknown as displacements of all nodes, global components.
    [[nodiscard]] Matrix displacement_basis() const {
        Matrix B = Matrix::Zero(3 * nodes, system.size());
        for (Index node = 0; node < nodes; ++node)
            for (int k = 0; k < 3; ++k)
                if (const Index e = constraints.equation(node, k); e != Constraints::held)
                    B.block<3, 1>(3 * node, e) = constraints.frame(node).col(k);
        return B;
    }
    /// Columns: the contact force of coupling j, global components.
    [[nodiscard]] Matrix force_basis(Index j) const {
        Matrix B = Matrix::Zero(3, system.size());
        B.middleCols<3>(system.unknowns().multiplier(j)) = constraints.frame(system.couplings()[j].slave);
        return B;
    }
    /// Global equilibrium (3 nodes x size) and contact laws (3 x size each) put into their rows.
    [[nodiscard]] Matrix in_rows(const Matrix& equilibrium, const std::vector<Matrix>& laws) const {
        Matrix J = Matrix::Zero(system.size(), system.size());
        for (Index node = 0; node < nodes; ++node)
            for (int k = 0; k < 3; ++k)
                if (const Index row = system.unknowns().equilibrium_row(node, k); row != Constraints::held)
                    J.row(row) = constraints.frame(node).col(k).transpose() * equilibrium.middleRows<3>(3 * node);
        for (Index j = 0; j < static_cast<Index>(laws.size()); ++j)
            for (int k = 0; k < 3; ++k)
                J.row(system.unknowns().contact_row(j, k)) =
                    constraints.frame(system.couplings()[j].slave).col(k).transpose() * laws[j];
        return J;
    }
    /// K u - (contact forces on their slaves).
    [[nodiscard]] Matrix base_equilibrium() const {
        Matrix equilibrium = dense_of(K) * displacement_basis();
        for (Index j = 0; j < static_cast<Index>(system.couplings().size()); ++j)
            equilibrium.middleRows<3>(3 * system.couplings()[j].slave) -= force_basis(j);
        return equilibrium;
    }
    [[nodiscard]] std::vector<Matrix> no_laws() const {
        return std::vector<Matrix>(system.couplings().size(), Matrix::Zero(3, system.size()));
    }
};

TEST(SystemMatrix, IsTheStiffnessOfTheFreeComponentsWithoutContact) {
    const BlockMatrix K = stiffness();
    const Constraints constraints = supports();
    const SystemMatrix system(constraints, K, {});
    Matrix B = Matrix::Zero(3 * nodes, constraints.equations());
    for (Index node = 0; node < nodes; ++node)
        for (int k = 0; k < 3; ++k) {
            const Index e = constraints.equation(node, k);
            EXPECT_EQ(system.unknowns().equilibrium_row(node, k), e);
            if (e != Constraints::held) B.block<3, 1>(3 * node, e) = constraints.frame(node).col(k);
        }
    ASSERT_EQ(system.size(), constraints.equations());
    const Matrix J = dense_of(system.matrix());
    EXPECT_LT((J - B.transpose() * dense_of(K) * B).cwiseAbs().maxCoeff(), 10 * round_off);
    EXPECT_LT((J - J.transpose()).cwiseAbs().maxCoeff(), 10 * round_off);
    EXPECT_TRUE(system.matrix().symmetric_positive_definite);
}

TEST_F(WithContact, GivesEveryRowToOneEquation) {
    std::vector<Index> rows;
    for (Index node = 0; node < nodes; ++node)
        for (int k = 0; k < 3; ++k) {
            const Index row = system.unknowns().equilibrium_row(node, k);
            EXPECT_EQ(row == Constraints::held, constraints.equation(node, k) == Constraints::held);
            if (row != Constraints::held) rows.push_back(row);
        }
    for (Index j = 0; j < static_cast<Index>(system.couplings().size()); ++j)
        for (int k = 0; k < 3; ++k) rows.push_back(system.unknowns().contact_row(j, k));
    std::sort(rows.begin(), rows.end());
    std::vector<Index> expected(static_cast<std::size_t>(system.size()));
    std::iota(expected.begin(), expected.end(), 0);
    EXPECT_EQ(rows, expected);
    EXPECT_EQ(system.size(), constraints.equations() + 3 * static_cast<Index>(couplings().size()));
}

TEST_F(WithContact, ExchangesTheRowsOfASlaveWithItsFirstContactForce) {
    for (int k = 0; k < 3; ++k) {
        EXPECT_EQ(system.unknowns().equilibrium_row(3, k), system.unknowns().multiplier(0) + k);
        EXPECT_EQ(system.unknowns().contact_row(0, k), constraints.equation(3, k));
        EXPECT_EQ(system.unknowns().contact_row(5, k), system.unknowns().multiplier(5) + k)
            << "the second pair of node 3 keeps its rows";
        EXPECT_EQ(system.unknowns().contact_row(3, k), system.unknowns().multiplier(3) + k) << "node 2 is fixed";
        EXPECT_EQ(system.unknowns().equilibrium_row(8, k), constraints.equation(8, k)) << "not a slave";
    }
    EXPECT_EQ(system.unknowns().contact_row(1, 1), system.unknowns().multiplier(1) + 1) << "node 4 is held along y";
    EXPECT_EQ(system.unknowns().contact_row(1, 0), constraints.equation(4, 0));
}

TEST_F(WithContact, HoldsStiffnessAndContactForcesAtFirst) {
    EXPECT_FALSE(system.matrix().symmetric_positive_definite);
    EXPECT_LT((dense_of(system.matrix()) - in_rows(base_equilibrium(), no_laws())).cwiseAbs().maxCoeff(),
              10 * round_off);
}

TEST_F(WithContact, KnowsWhichMastersItCovers) {
    const std::vector<Index> part{9, 6}, stranger{6, 10}, none;
    EXPECT_TRUE(system.covers(0, part));
    EXPECT_FALSE(system.covers(0, stranger));
    EXPECT_TRUE(system.covers(6, none));
    EXPECT_FALSE(system.covers(6, part));
}

TEST_F(WithContact, AddsContactTangentsLikeItsDenseTwin) {
    // patches of this iteration: some masters of the pattern, in any order
    const std::vector<std::vector<Index>> patches{{8, 6, 9}, {7, 6}, {12, 9, 4, 8}, {10}, {10, 9}, {13, 10, 11}};
    Random random(72);
    Matrix equilibrium = base_equilibrium();
    std::vector<Matrix> laws = no_laws();
    const Matrix B = displacement_basis();
    system.reset();
    for (Index j = 0; j < static_cast<Index>(patches.size()); ++j) {
        const auto& masters = patches[j];
        const auto n = static_cast<Index>(masters.size());
        const Matrix A = random_matrix(3 + 3 * n, random).topRows(3),
                     G = random_matrix(3 + 3 * n, random).topRows(3 * n), E = random_matrix(3 * n, random).leftCols(3);
        const Mat3 D = random_matrix(3, random);
        system.add_contact(j, masters, A, D, E, G);

        Matrix dy(3 + 3 * n, system.size()); // motion of slave and masters
        dy.topRows<3>() = B.middleRows<3>(3 * system.couplings()[j].slave);
        for (Index i = 0; i < n; ++i) dy.middleRows<3>(3 + 3 * i) = B.middleRows<3>(3 * masters[i]);
        laws[j] = A * dy + D * force_basis(j);
        for (Index i = 0; i < n; ++i)
            equilibrium.middleRows<3>(3 * masters[i]) +=
                G.middleRows<3>(3 * i) * dy + E.middleRows<3>(3 * i) * force_basis(j);
    }
    const Mat3 D = random_matrix(3, random);
    system.add_contact(6, D);
    laws[6] = D * force_basis(6);
    const Matrix expected = in_rows(equilibrium, laws);
    EXPECT_LT((dense_of(system.matrix()) - expected).cwiseAbs().maxCoeff(), 10 * round_off);

    system.reset();
    EXPECT_LT((dense_of(system.matrix()) - in_rows(base_equilibrium(), no_laws())).cwiseAbs().maxCoeff(),
              10 * round_off);
}

TEST_F(WithContact, AddsTangentsOfOpenCouplingsWhateverIsHeld) {
    std::vector<Matrix> laws = no_laws();
    Random random(73);
    for (Index j = 0; j < static_cast<Index>(laws.size()); ++j) {
        const Mat3 D = random_matrix(3, random);
        system.add_contact(j, D);
        laws[j] = D * force_basis(j);
    }
    EXPECT_LT((dense_of(system.matrix()) - in_rows(base_equilibrium(), laws)).cwiseAbs().maxCoeff(), 10 * round_off);
}

TEST_F(WithContact, TellsSolversWhatHasChanged) {
    const std::uint64_t pattern = system.matrix().pattern, revision = system.matrix().revision;
    system.reset();
    system.finish();
    EXPECT_EQ(system.matrix().pattern, pattern);
    EXPECT_NE(system.matrix().revision, revision);
    EXPECT_NE(SystemMatrix(constraints, K, couplings()).matrix().pattern, pattern);
}

} // namespace
} // namespace osculate::linear::OSCULATE_THIS_FILE
