#include "osculate/linear/dependence.hpp"

#include "osculate/linear/folded_matrix.hpp"

#include <algorithm>
#include <gtest/gtest.h>
#include <random>

namespace osculate::linear::OSCULATE_THIS_FILE {
namespace {

std::mt19937 generator(5);

Matrix random(Index rows, Index columns) {
    std::uniform_real_distribution<double> uniform(-1, 1);
    return Matrix::NullaryExpr(rows, columns, [&] { return uniform(generator); });
}

/// Nodes 0 to 5 of their own; 6 and 7 follow 4 and 5, 8 follows 5 alone.
Dependence some() {
    Dependence dependence(9);
    for (const Index node : {6, 7})
        dependence.set(node, {{4, random(3, 3), random(3, 3)}, {5, random(3, 3), random(3, 3)}});
    dependence.set(8, {{5, random(3, 3), random(3, 3)}});
    return dependence;
}

Field random_field() {
    Field field(9);
    for (Vec3& value : field) value = random(3, 1);
    return field;
}

TEST(Dependence, SpreadsMotionsAndFoldsForces) {
    const Dependence dependence = some();
    Field u = random_field(), f = random_field();
    const Field u_before = u, f_before = f;
    dependence.move(u);
    dependence.fold(f);
    for (const Index node : {0, 1, 2, 3, 4, 5}) EXPECT_EQ(u[node], u_before[node]);
    const auto six = dependence.carriers(6);
    EXPECT_LT((u[6] - six[0].moves * u[4] - six[1].moves * u[5]).norm(), 1e-15);
    EXPECT_TRUE(f[6].isZero(0));
    EXPECT_LT((f[4] - f_before[4] - six[0].loads * f_before[6] - dependence.carriers(7)[0].loads * f_before[7]).norm(),
              1e-15);
    EXPECT_EQ(f[3], f_before[3]);
}

/// What a folded contact does to motions and forces is what the contact does between spreading and folding.
void expect_same(Index slave, const std::vector<Index>& masters, Index loaded) {
    const Dependence dependence = some();
    const auto n = static_cast<Index>(masters.size());
    const Matrix A = random(3, 3 + 3 * n), E = random(3 * loaded, 3), G = random(3 * loaded, 3 + 3 * n);
    const FoldedContact folded(dependence, slave, masters, A, E, G);
    for (const Index node : folded.masters) EXPECT_FALSE(dependence.depends(node));

    Field u = random_field();
    dependence.move(u);
    const Vec3 lambda = random(3, 1);
    const auto gather = [&](const std::vector<Index>& nodes) {
        Vector y = Vector::Zero(3 + 3 * static_cast<Index>(nodes.size()));
        y.head<3>() = u[slave];
        for (std::size_t i = 0; i < nodes.size(); ++i) y.segment<3>(3 + 3 * static_cast<Index>(i)) = u[nodes[i]];
        return y;
    };
    Vector own = gather(folded.masters);
    if (dependence.depends(slave)) own.head<3>().setZero(); // it has no columns
    EXPECT_LT((A * gather(masters) - folded.A * own).norm(), 1e-13);

    Field f(9), g(9);
    const Vector forces = E * lambda + G * gather(masters), others = folded.E * lambda + folded.G * own;
    for (Index i = 0; i < loaded; ++i) f[masters[static_cast<std::size_t>(i)]] += forces.segment<3>(3 * i);
    if (dependence.depends(slave)) f[slave] -= lambda; // an independent slave's is written elsewhere
    dependence.fold(f);
    for (Index i = 0; i < others.size() / 3; ++i)
        g[folded.masters[static_cast<std::size_t>(i)]] += others.segment<3>(3 * i);
    for (std::size_t node = 0; node < f.size(); ++node) EXPECT_LT((f[node] - g[node]).norm(), 1e-13) << node;

    std::vector<Index> pattern = masters;
    replace_dependent(dependence, slave, pattern);
    for (const Index node : folded.masters) EXPECT_TRUE(std::ranges::count(pattern, node) > 0) << node;
}

TEST(FoldedContact, IsTheContactBetweenSpreadingAndFolding) {
    expect_same(0, {6, 7, 8}, 3);       // a master that depends on others
    expect_same(0, {6, 1, 7, 2, 8}, 3); // in part, with nodes behind that carry no force
    expect_same(6, {0, 1, 2, 3}, 4);    // a slave that does
    expect_same(7, {0, 4, 1}, 2);       // whose carrier is a master, too
    expect_same(6, {8, 0, 2}, 2);       // both
    expect_same(3, {0, 1}, 2);          // neither
}

/// Of nodes that carry elements together with others: the folded matrix does what spreading, multiplying and folding do.
TEST(FoldedMatrix, IsTheMatrixBetweenSpreadMotionsAndFoldedForces) {
    const Dependence dependence = some();
    BlockMatrix A(9, {{0, 1, 6, 7}, {1, 2, 6, 8}, {2, 3}, {4, 5}});
    for (Index k = 0; k < A.row_end(8); ++k) A.block(k) = random(3, 3);
    EXPECT_TRUE(needs_folding(dependence, A));
    EXPECT_FALSE(needs_folding(dependence, BlockMatrix(9, {{0, 1}, {4, 5}, {6}, {7}, {8}})));
    FoldedMatrix folded(dependence, A);
    for (int again = 0; again < 2; ++again) {
        folded.fold(A);
        Field u = random_field(), f(9), direct(9);
        dependence.move(u);
        A.multiply_add(u, f, 1);
        dependence.fold(f);
        folded.matrix().multiply_add(u, direct, 1);
        for (std::size_t i = 0; i < f.size(); ++i) EXPECT_LT((f[i] - direct[i]).norm(), 1e-14) << i;
    }
    for (const Index node : {6, 7, 8}) {
        EXPECT_EQ(folded.matrix().row_end(node) - folded.matrix().row_begin(node), 1);
        EXPECT_TRUE(folded.matrix().block(folded.matrix().row_begin(node)).isZero(0));
    }
}

} // namespace
} // namespace osculate::linear::OSCULATE_THIS_FILE
