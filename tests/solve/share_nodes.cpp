/// Which process gets which node.

#include "osculate/solve/join_ranks.hpp"

#include <gtest/gtest.h>
#include <numeric>

namespace osculate::solve::OSCULATE_THIS_FILE {
namespace {

/// A square of n x n nodes, each beside those at its sides.
std::vector<std::vector<Index>> square(Index n) {
    std::vector<std::vector<Index>> neighbours;
    for (Index i = 0; i < n * n; ++i) {
        std::vector<Index>& own = neighbours.emplace_back();
        if (i >= n) own.push_back(i - n);
        if (i % n > 0) own.push_back(i - 1);
        own.push_back(i);
        if (i % n + 1 < n) own.push_back(i + 1);
        if (i + n < n * n) own.push_back(i + n);
    }
    return neighbours;
}

TEST(ShareNodes, GivesEachProcessAboutAsMany) {
    for (const int ranks : {1, 2, 3, 4}) {
        std::vector<int> count(static_cast<std::size_t>(ranks), 0);
        for (const int owner : share_nodes(square(30), ranks)) ++count[static_cast<std::size_t>(owner)];
        for (const int one : count) EXPECT_NEAR(one, 900.0 / ranks, 0.1 * 900 / ranks) << ranks;
    }
}

/// Shared out by clusters of nodes: as even, with borders less than twice as long as those of squares, which crosses cannot follow.
TEST(ShareNodes, SharesLargeModelsAlongShortBorders) {
    constexpr Index n = 300;
    const std::vector<std::vector<Index>> neighbours = square(n);
    for (const auto& [ranks, border] : {std::pair{2, 1.0 * n}, {4, 2.0 * n}}) {
        const std::vector<int> owner = share_nodes(neighbours, ranks);
        std::vector<int> count(static_cast<std::size_t>(ranks), 0);
        int cut = 0;
        for (std::size_t i = 0; i < owner.size(); ++i) {
            ++count[static_cast<std::size_t>(owner[i])];
            for (const Index j : neighbours[i]) cut += owner[static_cast<std::size_t>(j)] != owner[i] ? 1 : 0;
        }
        for (const int one : count) EXPECT_NEAR(one, 1.0 * n * n / ranks, 0.01 * n * n / ranks) << ranks;
        EXPECT_LT(cut / 2, 2 * border) << ranks;
    }
}

/// Opposite sides follow each other, and the corners by both sides.
TEST(ShareNodes, KeepsNodesTogetherThatFollowEachOther) {
    constexpr Index n = 30;
    std::vector<std::pair<Index, Index>> together;
    for (Index k = 0; k < n; ++k) {
        together.emplace_back(k, n * (n - 1) + k);
        together.emplace_back(n * k + n - 1, n * k);
    }
    for (const int ranks : {2, 3, 7}) {
        const std::vector<int> owner = share_nodes(square(n), ranks, together);
        ASSERT_EQ(owner.size(), static_cast<std::size_t>(n * n));
        for (const auto& [a, b] : together)
            EXPECT_EQ(owner[static_cast<std::size_t>(a)], owner[static_cast<std::size_t>(b)]);
        std::vector<int> count(static_cast<std::size_t>(ranks), 0);
        for (const int one : owner) ++count[static_cast<std::size_t>(one)];
        for (const int one : count) EXPECT_NEAR(one, 900.0 / ranks, 0.1 * 900 / ranks) << ranks;
    }
}

} // namespace
} // namespace osculate::solve::OSCULATE_THIS_FILE
