#include "osculate/core/lists.hpp"

#include "osculate/linear/block_matrix.hpp"
#include "support/random.hpp"

#include <gtest/gtest.h>
#include <set>

namespace osculate::OSCULATE_THIS_FILE {
namespace {

TEST(Lists, ComeOneAfterAnother) {
    const Lists lists(std::vector<std::vector<Index>>{{3, 1}, {}, {2}});
    ASSERT_EQ(lists.size(), 3U);
    EXPECT_EQ(lists.number, (std::vector<Index>{3, 1, 2}));
    EXPECT_EQ(lists[0].size(), 2U);
    EXPECT_TRUE(lists[1].empty());
    EXPECT_EQ(lists[2][0], 2);
    EXPECT_EQ(Lists().size(), 0U);
}

TEST(Lists, NameThePlacesOfEachValue) {
    const Lists places = places_of(std::vector<int>{2, 0, 2, 4, 0}, 6);
    ASSERT_EQ(places.size(), 6U);
    const std::vector<std::vector<Index>> expected{{1, 4}, {}, {0, 2}, {}, {3}, {}};
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_EQ(std::vector<Index>(places[i].begin(), places[i].end()), expected[i]) << i;
    EXPECT_EQ(places_of(std::vector<int>(), 0).size(), 0U);
}

/// Against sets; nodes without elements, elements of one node and of one node twice among them.
TEST(Lists, NeighboursAreTheNodesOfAllElementsAtANode) {
    support::Random random(5);
    constexpr Index nodes = 40;
    std::vector<std::vector<Index>> elements;
    std::vector<std::set<Index>> expected(nodes);
    for (int e = 0; e < 25; ++e) {
        std::vector<Index>& element = elements.emplace_back();
        const auto length = static_cast<int>(random.uniform(1, 9));
        for (int k = 0; k < length; ++k) element.push_back(static_cast<Index>(random.uniform(0, nodes - 3)));
        for (const Index node : element)
            expected[static_cast<std::size_t>(node)].insert(element.begin(), element.end());
    }
    const Lists found = linear::neighbours(nodes, elements);
    ASSERT_EQ(found.size(), expected.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        EXPECT_EQ(std::vector<Index>(found[i].begin(), found[i].end()),
                  std::vector<Index>(expected[i].begin(), expected[i].end()))
            << i;
}

} // namespace
} // namespace osculate::OSCULATE_THIS_FILE
