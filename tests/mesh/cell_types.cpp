#include "osculate/mesh/cell_type.hpp"

#include <gtest/gtest.h>

namespace osculate::mesh {
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
}

} // namespace
} // namespace osculate::mesh
