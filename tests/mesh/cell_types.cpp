#include "osculate/mesh/cell_type.hpp"

#include <gtest/gtest.h>

namespace osculate::mesh::OSCULATE_THIS_FILE {
namespace {

TEST(CellTypes, HaveNamesInASentence) {
    const auto named = [](std::string_view last, std::initializer_list<CellType> types) {
        return cell_names(last, [&](const CellInfo& info) { return std::ranges::count(types, info.type) > 0; });
    };
    EXPECT_EQ(named("or", {CellType::hex8, CellType::wedge6, CellType::tet4}), "hex8, wedge6 or tet4");
    EXPECT_EQ(named("and", {CellType::hex8, CellType::tet10}), "hex8 and tet10");
    EXPECT_EQ(named("and", {CellType::tet10}), "tet10");
    EXPECT_EQ(named("and", {}), "");
}

TEST(CellTypes, HaveATypeOfTheSameCornersWithoutMidsideNodes) {
    EXPECT_EQ(without_midside_nodes(cell_info(CellType::tet10)).type, CellType::tet4);
    EXPECT_EQ(without_midside_nodes(cell_info(CellType::wedge6)).type, CellType::wedge6);
    EXPECT_EQ(without_midside_nodes(cell_info(CellType::wedge15)).type, CellType::wedge6);
    EXPECT_TRUE(is_wedge(CellType::wedge15));
    EXPECT_FALSE(is_wedge(CellType::hex20));
}

TEST(CellTypes, OfFifteenNodesHaveTheirMidsideNodesBetweenTheSameCornersInOtherPrograms) {
    // edges in the order of their midside nodes, as Gmsh and Abaqus list them
    using Edges = std::vector<std::array<int, 2>>;
    const Edges gmsh{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 4}, {2, 5}, {3, 4}, {3, 5}, {4, 5}},
        deck{{0, 1}, {1, 2}, {2, 0}, {3, 4}, {4, 5}, {5, 3}, {0, 3}, {1, 4}, {2, 5}};
    const CellInfo& wedge = cell_info(CellType::wedge15);
    for (const auto& [theirs, order] :
         {std::pair{gmsh, wedge.from_gmsh}, std::pair{deck, wedge.from_deck}, std::pair{deck, wedge.mirrored}})
        for (std::size_t e = 0; e < wedge.edges.size(); ++e) {
            const int a = order[static_cast<std::size_t>(wedge.edges[e][0])],
                      b = order[static_cast<std::size_t>(wedge.edges[e][1])];
            const auto [first, second] = theirs[static_cast<std::size_t>(order[6 + e] - 6)];
            EXPECT_TRUE((first == a && second == b) || (first == b && second == a)) << "edge " << e;
        }
}

} // namespace
} // namespace osculate::mesh::OSCULATE_THIS_FILE
