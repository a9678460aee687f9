#include "app/report/curve_rows.hpp"

#include <gmock/gmock.h>

namespace osculate::app::OSCULATE_THIS_FILE {
namespace {

using testing::ElementsAre;

const std::vector<std::string> columns{"time", "pair.left.normal", "pair.right-side.normal", "pair.left.area"};

TEST(CurveRows, AStarIsACurveForEveryColumnThatFits) {
    const auto both = expanded("2*pair.*.normal", columns);
    ASSERT_EQ(both.size(), 2U);
    EXPECT_EQ(both[0].text, "2*pair.left.normal");
    EXPECT_EQ(both[1].text, "2*pair.right_side.normal") << "formulas know no '-' in names";
    EXPECT_TRUE(both[0].of_several);
    const auto ratio = expanded("pair.*.normal / pair.*.area", columns);
    EXPECT_EQ(ratio[0].text, "pair.left.normal / pair.left.area");
    EXPECT_FALSE(expanded("pair.*.area", columns)[0].of_several);
    EXPECT_TRUE(expanded("pair.*.friction", columns).empty());
    EXPECT_EQ(expanded("2 * time * 3.", columns)[0].text, "2 * time * 3.");
}

TEST(CurveRows, AreThoseAskedForInTheirOrder) {
    const scene::Rows table{{"time", "s", "v"}, {{1, 1, 2, 2}, {0, 1, 0, 1}, {5, 6, 7, 8}}};
    scene::Curve curve;
    curve.x = "s";
    curve.y = "v + 1";
    const auto points = [&] { return *curve_points(curve, {curve.y, {}, false}, table); };
    EXPECT_THAT(points().second, ElementsAre(6, 7, 8, 9));
    curve.last = true;
    EXPECT_THAT(points().second, ElementsAre(8, 9));
    curve.where = "s > 0";
    EXPECT_THAT(points().first, ElementsAre(1));
    EXPECT_THAT(points().second, ElementsAre(9));
    curve.y = "w";
    EXPECT_FALSE(curve_points(curve, {curve.y, {}, false}, table)) << "a column that this table lacks";
}

} // namespace
} // namespace osculate::app::OSCULATE_THIS_FILE
