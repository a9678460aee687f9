#include "block_systems.hpp"
#include "osculate/linear/gathered.hpp"
#include "support/thread_ranks.hpp"

#include <gtest/gtest.h>

namespace osculate::linear::OSCULATE_THIS_FILE {
namespace {

using namespace fixtures;
using osculate::support::Random;

TEST(BlockMatrix, AddsElementsAtTheirNodes) {
    Random random(61);
    Matrix dense = Matrix::Zero(3 * 9, 3 * 9);
    const auto elements = some_elements();
    BlockMatrix K(9, elements);
    for (const auto& element : elements) {
        const auto n = static_cast<Index>(element.size());
        const Matrix Ke = random_matrix(3 * n, random);
        K.add(element, Ke);
        for (Index i = 0; i < n; ++i)
            for (Index j = 0; j < n; ++j)
                dense.block<3, 3>(3 * element[i], 3 * element[j]) += Ke.block<3, 3>(3 * i, 3 * j);
    }
    EXPECT_EQ(dense_of(K), dense);
}

TEST(BlockMatrix, HasTheNodesThatShareAnElementInItsPattern) {
    const BlockMatrix K(9, some_elements());
    const std::vector<std::vector<Index>> expected{{0, 1, 2, 3},
                                                   {0, 1, 2, 3},
                                                   {0, 1, 2, 3, 4, 5},
                                                   {0, 1, 2, 3, 4, 5},
                                                   {2, 3, 4, 5},
                                                   {2, 3, 4, 5},
                                                   {6, 7},
                                                   {6, 7},
                                                   {}};
    ASSERT_EQ(K.rows(), 9);
    for (Index row = 0; row < 9; ++row) {
        std::vector<Index> columns;
        for (Index k = K.row_begin(row); k < K.row_end(row); ++k) columns.push_back(K.column(k));
        EXPECT_EQ(columns, expected[row]) << "row " << row;
    }
}

TEST(BlockMatrix, MultipliesLikeItsDenseTwinOnAnyNumberOfThreads) {
    const Index nodes = 200;
    std::vector<std::vector<Index>> elements;
    for (Index e = 0; e + 7 < nodes; e += 2) elements.push_back({e, e + 3, e + 1, e + 7});
    Random random(62);
    BlockMatrix K(nodes, elements);
    for (const auto& element : elements) K.add(element, random_matrix(12, random));
    Field x(nodes), start(nodes);
    Vector flat(3 * nodes), expected(3 * nodes);
    for (Index i = 0; i < nodes; ++i) {
        flat.segment<3>(3 * i) = x[i] = random.vector();
        expected.segment<3>(3 * i) = start[i] = random.vector();
    }
    expected += dense_of(K) * flat; // y += A x
    Field first;
    for (const int threads : {1, 2, 5}) {
        Field y = start;
        K.multiply_add(x, y, threads);
        const double round_off = 1e-14; // of sums of about thirty products
        for (Index i = 0; i < nodes; ++i) EXPECT_LT((y[i] - expected.segment<3>(3 * i)).norm(), 100 * round_off);
        if (first.empty()) first = y;
        EXPECT_EQ(y, first) << "not the same bits with " << threads << " threads";
    }
}

TEST(BlockMatrix, TakesNoNoticeOfATranslationInRelativeProducts) {
    const Index nodes = 4;
    const std::vector<std::vector<Index>> elements{{0, 1, 2}, {1, 2, 3}};
    Random random(63);
    BlockMatrix K(nodes, elements);
    for (const auto& element : elements) {
        Matrix Ke = random_matrix(9, random);
        Ke.rightCols<3>() = -Ke.leftCols<3>() - Ke.middleCols<3>(3); // blocks of a row add up to nothing
        K.add(element, Ke);
    }
    Field x(nodes), far(nodes), y(nodes), product = y, y_far = y;
    for (Index i = 0; i < nodes; ++i) {
        for (int k = 0; k < 3; ++k) x[i](k) = std::round(1e3 * random.vector()(k)) / 1024; // shifts are exact
        far[i] = x[i] + Vec3(1 << 20, -(1 << 20), 1 << 20);
    }
    K.multiply_add(x, product, 1);
    K.multiply_add_relative(x, y, 1);
    K.multiply_add_relative(far, y_far, 2);
    EXPECT_EQ(y, y_far);
    for (Index i = 0; i < nodes; ++i) EXPECT_LT((y[i] - product[i]).norm(), 1e-13);
}

TEST(BlockMatrix, IsEmptyAtFirst) {
    EXPECT_EQ(BlockMatrix{}.rows(), 0);
}

TEST(BlockMatrix, MultipliesAsOneWhereProcessesShareItsRows) {
    Random random(67);
    const auto elements = some_elements();
    BlockMatrix whole(9, elements);
    std::vector<Matrix> matrices;
    for (const auto& element : elements) {
        matrices.push_back(random_matrix(3 * static_cast<Index>(element.size()), random));
        whole.add(element, matrices.back());
    }
    Field x(9), expected(9, Vec3(1, 2, 3)), expected_relative(9, Vec3(1, 2, 3));
    for (Vec3& value : x) value = Vec3(random.uniform(), random.uniform(), random.uniform());
    whole.multiply_add(x, expected, 1);
    whole.multiply_add_relative(x, expected_relative, 1);
    osculate::support::on_ranks(3, [&](const std::shared_ptr<Ranks>& ranks) {
        const auto share = std::make_shared<const Share>(ranks, std::vector<int>{0, 1, 2, 2, 0, 1, 1, 0, 2});
        BlockMatrix own(neighbours(9, elements), share);
        for (std::size_t e = 0; e < elements.size(); ++e) own.add(elements[e], matrices[e]);
        for (Index row = 0; row < 9; ++row) {
            if (!share->owns(row)) {
                EXPECT_EQ(own.row_begin(row), own.row_end(row));
            }
        }
        Field y(9, Vec3(1, 2, 3)), relative(9, Vec3(1, 2, 3));
        own.multiply_add(x, y, 1);
        own.multiply_add_relative(x, relative, 1);
        for (std::size_t i = 0; i < 9; ++i) {
            EXPECT_LT((y[i] - expected[i]).norm(), 1e-14);
            EXPECT_LT((relative[i] - expected_relative[i]).norm(), 1e-14);
        }
        Field of_own(9, Vec3(1, 2, 3));
        own.multiply_add(share->nodes_of(ranks->rank()), x, of_own, 1);
        for (Index i = 0; i < 9; ++i)
            EXPECT_LT((of_own[i] - (share->owns(i) ? expected[i] : Vec3(1, 2, 3))).norm(), 1e-14);
        EXPECT_EQ(own.diagonal(), whole.diagonal());
        const BlockMatrix all = gathered(own);
        EXPECT_EQ(all.share(), nullptr);
        EXPECT_EQ(dense_of(all), dense_of(whole));
    });
}

TEST(BlockMatrix, KnowsItsDiagonal) {
    BlockMatrix K(std::vector<std::vector<Index>>{{0, 1}, {}, {1, 2}}); // a node without elements
    K.block(K.slot(0, 0)).diagonal() = Vec3(1, 2, 3);
    K.block(K.slot(2, 2)).setConstant(4);
    EXPECT_EQ(K.diagonal().values(), (std::vector<Vec3>{Vec3(1, 2, 3), Vec3::Zero(), Vec3(4, 4, 4)}));
}

} // namespace
} // namespace osculate::linear::OSCULATE_THIS_FILE
