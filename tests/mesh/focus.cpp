/// Blocks with a focus and a crown; tubes that are cut.

#include "mesh/shapes.hpp"
#include "osculate/mesh/quality.hpp"

#include <algorithm>
#include <gmock/gmock.h>
#include <set>
#include <stdexcept>

namespace osculate::mesh::OSCULATE_THIS_FILE {
namespace {

using ::testing::IsEmpty;
constexpr double round_off = 1e-13; ///< relative, of a node's position

TEST(FocusedLines, HaveTheSizeGivenAroundThePointAndGrowNoFasterThanAllowedBeyond) {
    const Focus focus{.size = 0.25, .extent = 1.2, .growth = 1.4};
    const std::vector<double> lines = focused_lines(-10, 3, 0, focus);
    EXPECT_EQ(lines.front(), -10);
    EXPECT_EQ(lines.back(), 3);
    EXPECT_TRUE(std::ranges::count(lines, 0.) == 1) << "the point is a line";
    for (std::size_t i = 1; i + 1 < lines.size(); ++i) {
        const double before = lines[i] - lines[i - 1], after = lines[i + 1] - lines[i];
        EXPECT_LE(std::max(after / before, before / after), 1.4 + round_off);
        if (std::abs(lines[i]) < 1.2) {
            EXPECT_NEAR(before, 0.25, round_off);
            EXPECT_NEAR(after, 0.25, round_off);
        } else if (lines[i] != -1.25 && lines[i] != 1.25) {
            EXPECT_GT(lines[i] > 0 ? after / before : before / after, 1) << "they grow at " << lines[i];
        }
    }
}

TEST(FocusedLines, AreNoMoreThanTheGrowthAsksFor) {
    const Focus focus{.size = 0.25, .extent = 1, .growth = 1.4};
    for (double length = 1.3; length < 20; length += 0.1) {
        const std::vector<double> lines = focused_lines(0, length, 0, focus);
        double reached = 1, element = focus.size; // by one element less, as large as they may be
        for (std::size_t i = 5; i + 1 < lines.size(); ++i) reached += element *= focus.growth;
        EXPECT_LT(reached, length) << lines.size();
    }
}

/// A half has to be a part of the whole, to the last digit.
TEST(FocusedLines, OfOneSideDoNotDependOnTheOther) {
    const Focus focus{.size = 0.25, .extent = 1.2, .growth = 1.4};
    const std::vector<double> whole = focused_lines(-10, 10, 0, focus), half = focused_lines(0, 10, 0, focus);
    ASSERT_EQ(whole.size(), 2 * half.size() - 1);
    for (std::size_t i = 0; i < half.size(); ++i) {
        EXPECT_EQ(whole[half.size() - 1 + i], half[i]);
        EXPECT_EQ(whole[half.size() - 1 - i], -half[i]);
    }
}

TEST(FocusedLines, ShareOutWhatHasNoRoomToGrow) {
    const std::vector<double> few = focused_lines(0, 1, 0, {.size = 0.4, .extent = 5});
    ASSERT_EQ(few.size(), 4U);
    for (std::size_t i = 1; i < few.size(); ++i) EXPECT_NEAR(few[i] - few[i - 1], 1. / 3, round_off);
    EXPECT_EQ(focused_lines(0, 1, 0, {.size = 7}).size(), 2U);
    EXPECT_EQ(focused_lines(0, 1, -3, {.size = 0.25, .extent = 1}), focused_lines(0, 1, 0, {.size = 0.25, .extent = 1}))
        << "a point outside stands for the nearest inside";
}

TEST(FocusedLines, RefuseImpossibleArguments) {
    EXPECT_THROW((void)focused_lines(0, 1, 0, {.size = -1}), std::invalid_argument);
    EXPECT_THROW((void)focused_lines(0, 1, 0, {.size = 0.1, .growth = 0.9}), std::invalid_argument);
    EXPECT_THROW((void)focused_lines(0, 1, 0, {.size = 1e-9, .extent = 1}), std::invalid_argument);
    EXPECT_THROW((void)focused_lines(0, 1, 0, {.size = 1e-9, .growth = 1}), std::invalid_argument);
}

TEST(FocusedBlock, IsSoundInEveryElementAndKeepsTheDivisionsOfOtherAxes) {
    const Focus focus{.point = {0, 0, 0.5}, .size = 0.1, .extent = 0.2, .growth = 1.5, .axes = {true, false, true}};
    for (const auto& [name, type] : fixtures::element_types()) {
        const Mesh block = make_block({-1, 0, 0}, {2, 1, 1}, {7, 3, 7}, type, BlockPattern::quad, focus);
        EXPECT_THAT(faults(block), IsEmpty()) << name;
        EXPECT_NEAR(fixtures::integrate(exterior_facets(block), block.nodes).volume, 2, 2e-12) << name;
        std::set<double> y;
        for (const Vec3& x : block.nodes) y.insert(x.y());
        EXPECT_EQ(y.size(), 3U * fixtures::facets_per_edge(type) + 1) << name;
    }
}

TEST(CrownedBlock, HasItsUndersideOnTheBallOrTheCylinderAndAFlatTop) {
    const double R = 5;
    const Focus focus{.point = {0.5, 0, 1}, .size = 0.1, .extent = 0.2};
    for (const Crown::Along along : {Crown::Along::none, Crown::Along::x, Crown::Along::y}) {
        const Mesh block =
            make_block({-1, -1, 1}, {3, 2, 2}, {1, 1, 1}, CellType::hex8, BlockPattern::quad, focus, {R, along});
        EXPECT_THAT(faults(block), IsEmpty());
        double lowest = 10;
        for (const Facet& facet : block.surfaces.at("z_min"))
            for (const Index n : facet) {
                Vec3 from = block.nodes[n] - Vec3(0.5, 0, 1 + R); // from the centre
                if (along == Crown::Along::x) from.x() = 0;
                if (along == Crown::Along::y) from.y() = 0;
                EXPECT_NEAR(from.norm(), R, round_off * R);
                lowest = std::min(lowest, block.nodes[n].z());
            }
        EXPECT_EQ(lowest, 1) << "it touches the plane of the origin";
        for (const Facet& facet : block.surfaces.at("z_max"))
            for (const Index n : facet) EXPECT_EQ(block.nodes[n].z(), 3);
    }
    const auto crowned = [](double radius, double height) {
        return make_block({0, 0, 0}, {3, 3, height}, {1, 1, 1}, CellType::hex8, BlockPattern::quad, {}, {radius});
    };
    EXPECT_NO_THROW((void)crowned(5, 3));
    EXPECT_THROW((void)crowned(4, 3), std::invalid_argument) << "narrower than the block";
    EXPECT_THROW((void)crowned(5, 1), std::invalid_argument) << "it would come out at the top";
    EXPECT_THROW((void)crowned(-5, 3), std::invalid_argument);
}

TEST(CutTube, IsAPartOfTheWholeTubeWithItsCutsInThePlanes) {
    const Mesh whole = make_tube(2, 0.5, 3, {24, 2, 2});
    for (const Portion portion : {Portion::half, Portion::quarter}) {
        const Mesh part = make_tube(2, 0.5, 3, {24, 2, 2}, portion);
        EXPECT_THAT(faults(part), IsEmpty());
        EXPECT_EQ(part.surfaces.size(), portion == Portion::half ? 5U : 6U);
        const double share = portion == Portion::half ? 0.5 : 0.25;
        const double volume = fixtures::integrate(exterior_facets(whole), whole.nodes).volume;
        EXPECT_NEAR(fixtures::integrate(exterior_facets(part), part.nodes).volume, share * volume, 1e-12 * volume);
        for (const Vec3& x : part.nodes) {
            double nearest = 1;
            for (const Vec3& y : whole.nodes) nearest = std::min(nearest, (x - y).norm());
            EXPECT_LT(nearest, 3 * round_off);
            EXPECT_GE(x.x(), 0);
        }
        for (const Facet& facet : part.surfaces.at("x_min"))
            for (const Index n : facet) EXPECT_EQ(part.nodes[n].x(), 0);
        if (portion == Portion::half) continue;
        for (const Facet& facet : part.surfaces.at("y_min"))
            for (const Index n : facet) EXPECT_EQ(part.nodes[n].y(), 0);
    }
    EXPECT_THROW((void)make_tube(2, 0.5, 3, {22, 2, 2}, Portion::half), std::invalid_argument);
}

} // namespace
} // namespace osculate::mesh::OSCULATE_THIS_FILE
