#include "osculate/scene/outline.hpp"

#include "osculate/scene/reader.hpp"
#include "scene/scene_text.hpp"
#include "support/source_tree.hpp"

#include <gtest/gtest.h>

namespace osculate::scene::OSCULATE_THIS_FILE {
namespace {

TEST(Engineering, LeavesOneToAThousandBeforeTheUnit) {
    EXPECT_EQ(engineering(3e7, "Pa"), "30 MPa");
    EXPECT_EQ(engineering(999, "Pa"), "999 Pa");
    EXPECT_EQ(engineering(1000, "Pa"), "1 kPa");
    EXPECT_EQ(engineering(0.05, "m"), "50 mm");
    EXPECT_EQ(engineering(-2.5e-5, "s"), "-25 µs");
    EXPECT_EQ(engineering(2e3, "N/m^3"), "2 kN/m³");
}

TEST(Engineering, KeepsUnitsThatTakeNoPrefix) {
    EXPECT_EQ(engineering(7850, "kg/m^3"), "7850 kg/m³");
    EXPECT_EQ(engineering(0.001, "m/s^2"), "0.001 m/s²");
    EXPECT_EQ(engineering(1200, "s"), "1200 s");
    EXPECT_EQ(engineering(5e7, "m"), "50000 km");
    EXPECT_EQ(engineering(0.2, ""), "0.2");
    EXPECT_EQ(engineering(0, "Pa"), "0 Pa");
    EXPECT_EQ(engineering(3e-17, "m"), "3e-17 m");
}

TEST(Outline, TellsASceneWithUnits) {
    const Scene scene = read_scene(support::source_tree() + "/configs/paper/half_tube.yaml");
    const OutlineItem root = outline(scene);
    const OutlineItem& contactor = *root.find("bodies")->find("contactor");
    EXPECT_EQ(contactor.find("material")->find("linear_elastic")->find("E")->text, "10 MPa");
    EXPECT_EQ(contactor.find("mesh")->find("contactor")->find("rear")->text, "500 mm");
    EXPECT_EQ(contactor.find("mesh")->find("contactor")->find("divisions")->text, "12 × 16 × 3");
    EXPECT_EQ(root.find("supports")->find("tube_outer")->find("fix")->text, "x, y, z");
    EXPECT_EQ(root.find("stages")->find("press")->find("pressure")->find("top")->text, "1 MPa");
    EXPECT_EQ(root.find("contact")->find("sliding")->find("master")->find("set")->text, "tube_inner");
}

TEST(Outline, GivesVectorsOnePrefix) {
    const Scene scene = read_scene(support::source_tree() + "/configs/tutorials/bouncing_ball.yaml");
    const OutlineItem root = outline(scene);
    EXPECT_EQ(root.find("gravity")->text, "(0, 0, -9.81) m/s²");
    EXPECT_EQ(root.find("bodies")->find("plate")->find("mesh")->find("block")->find("size")->text, "(200, 200, 20) mm");
    EXPECT_EQ(root.find("sets")->find("skin")->find("normal")->find("angle")->text, "60 deg");
}

} // namespace
} // namespace osculate::scene::OSCULATE_THIS_FILE
