/// Plane elements and equations of decks as parts of scenes.

#include "deck/imported.hpp"
#include "osculate/mesh/mesh_error.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <numbers>

namespace osculate::deck::OSCULATE_THIS_FILE {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

class ImportingPlanes : public Imports {
protected:
    /// A square of one element of a type, from x = 1 to 2, of which one edge is held and the other is pulled.
    static std::string square(const std::string& type, const std::string& section = "0.25\n") {
        const bool quadratic = type.find('8') != std::string::npos, triangles = type.find('3') != std::string::npos;
        return "*NODE, NSET=All\n1,1,0\n2,2,0\n3,2,1\n4,1,1\n5,1.5,0\n6,2,.5\n7,1.5,1\n8,1,.5\n"
               "*ELEMENT, TYPE=" +
               type + ", ELSET=Plate\n" +
               (quadratic   ? "1,1,2,3,4,5,6,7,8\n"
                : triangles ? "1,1,2,3\n2,1,3,4\n"
                            : "1,1,2,3,4\n") +
               "*NSET, NSET=Left\n1,4\n*SURFACE, NAME=Right\n1,S2\n*MATERIAL, NAME=M\n*ELASTIC\n1000,0.3\n"
               "*SOLID SECTION, ELSET=Plate, MATERIAL=M\n" +
               section + "*BOUNDARY\nLeft,1,2\n";
    }
    static constexpr const char* pull = "*STEP\n*STATIC\n*DLOAD\n1,P2,-2\n*CLOAD\n3,2,720\n*END STEP\n";
};

TEST_F(ImportingPlanes, BecomeOneLayerAsThickAsTheirSection) {
    for (const auto& [type, kind, nodes] : {std::tuple{"CPS4", "plane_stress", 8},
                                            {"CPE8R", "plane_strain", 20},
                                            {"CPS8", "plane_stress", 20},
                                            {"CPE3", "plane_strain", 8},
                                            {"CAX4", "axisymmetric", 8}}) {
        const ImportedScene imported = import(pull, DeckUnits::si, square(type));
        EXPECT_TRUE(imported.lost.empty()) << imported.text;
        EXPECT_THAT(imported.text, HasSubstr(std::string("slice: {kind: ") + kind)) << type;
        const scene::Scene scene = checked(imported);
        const app::Plan plan = plan_of(scene);
        const bool revolves = std::string(type) == "CAX4";
        double volume = 0, turn = 0.5 * std::numbers::pi / 180;
        for (const double share : {model::mass_properties(plan.model.bodies[0], 1).mass}) volume += share;
        // chords of a wedge of half a degree are 1e-5 shorter than arcs
        EXPECT_NEAR(volume, revolves ? 1.5 * turn : 0.25, 1e-5) << type;
        EXPECT_EQ(plan.model.bodies[0].nodes(), nodes) << type;
        EXPECT_EQ(scene.bodies[0].second.hex_formulation,
                  std::string(type) == "CPE8R" ? HexFormulation::reduced : HexFormulation::full);
        Vec3 sum = Vec3::Zero();
        for (const Vec3& f : plan.stages[0].force(plan.model.X.size(), 1)) sum += f;
        // of a force on the whole circle a wedge has its share
        EXPECT_NEAR(sum.y(), revolves ? 1 : 720, 1e-9) << type;
        EXPECT_NEAR(sum.x(), revolves ? 2 * 2 * turn : 0.5, 1e-4) << type;
    }
}

TEST_F(ImportingPlanes, HaveTheThicknessOfTheirOwnSection) {
    const std::string two = "*SOLID SECTION, ELSET=Other, MATERIAL=M\n0.5\n*ELSET, ELSET=Other\n1\n";
    EXPECT_NEAR(
        model::mass_properties(plan_of(checked(import(pull, DeckUnits::si, square("CPS4") + two))).model.bodies[0], 1)
            .mass,
        0.25, 1e-12);
    std::string unnamed = square("CPS4") + two;
    unnamed.replace(unnamed.find(", ELSET=Plate\n1,"), 13, "");
    try {
        (void)import(pull, DeckUnits::si, unnamed + "*ELSET, ELSET=Plate\n1\n");
        FAIL() << "two thicknesses for an element";
    } catch (const mesh::MeshError& error) {
        EXPECT_THAT(error.what(), HasSubstr("sections of other sets have several thicknesses"));
    }
}

TEST_F(ImportingPlanes, HaveTheirTemperaturesThroughTheLayer) {
    std::string model = square("CPE8");
    model.insert(model.find("*SOLID"), "*EXPANSION\n1e-5\n");
    const app::Plan plan = plan_of(checked(import("*STEP\n*STATIC\n*TEMPERATURE\nAll,50\n*END STEP\n", DeckUnits::si,
                                                  "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nAll,20\n" + model)));
    ASSERT_EQ(plan.stages[0].temperatures.size(), 1);
    EXPECT_EQ(plan.stages[0].temperatures[0].end, 30);
    EXPECT_EQ(plan.stages[0].temperatures[0].nodes.size(), 20);
}

TEST_F(ImportingPlanes, OnTheirAxisStandBesideIt) {
    // a solid cylinder of radius and height 1
    for (const auto& [type, elements] : {std::pair{"CAX3", "1,1,2,3\n2,1,3,4\n"},
                                         {"CAX4", "1,1,2,3,4\n"},
                                         {"CAX6", "1,1,2,3,5,6,9\n2,1,3,4,9,7,8\n"},
                                         {"CAX8", "1,1,2,3,4,5,6,7,8\n"}}) {
        const std::string model =
            std::string("*NODE\n1,0,0\n2,1,0\n3,1,1\n4,0,1\n5,.5,0\n6,1,.5\n7,.5,1\n8,0,.5\n9,.5,.5\n*ELEMENT, TYPE=") +
            type + ", ELSET=E\n" + elements +
            "*NSET, NSET=Axis\n1,4\n*NSET, NSET=Bed\n1,2\n*MATERIAL, NAME=M\n*ELASTIC\n1000,0.3\n*SOLID SECTION, "
            "ELSET=E, "
            "MATERIAL=M\n1.\n*BOUNDARY\nAxis,1\nBed,2\n";
        const ImportedScene imported = import("*STEP\n*STATIC\n*CLOAD\n3,2,-720\n*END STEP\n", DeckUnits::si, model);
        EXPECT_TRUE(imported.lost.empty()) << imported.text;
        EXPECT_THAT(imported.text, HasSubstr("what is on the axis stands beside it"));
        const app::Plan plan = plan_of(checked(imported));
        constexpr double turn = 0.5 * std::numbers::pi / 180, bore = 2e-6, chord = 1.3e-5; // relative
        EXPECT_NEAR(model::mass_properties(plan.model.bodies[0], 1).mass / (turn / 2), 1, bore + chord) << type;
    }
}

TEST_F(ImportingPlanes, EquationsThatDifferByTheirFirstNodeAreOne) {
    const std::string equations = "*EQUATION\n2\n15,3,1.,16,3,-1.\n2\n17,3,1.,16,3,-1.\n*EQUATION\n3\n"
                                  "18,1,2.,7,1,-1.,8,2,0.5\n";
    const std::string model = mesh_of_cubes + equations + properties;
    const ImportedScene imported = import("*STEP\n*STATIC\n*DSLOAD\nTop,P,1.\n*END STEP\n", DeckUnits::mm, model);
    // node 18 is held along x, so the equation leads one of the others
    EXPECT_TRUE(imported.lost.empty()) << imported.text;
    const app::Plan plan = plan_of(checked(imported));
    ASSERT_EQ(plan.model.led.size(), 3);
    for (const model::LedNode& one : plan.model.led) {
        ASSERT_GE(one.by.size(), 1);
        EXPECT_NEAR(one.direction.cwiseAbs().maxCoeff(), 1, 1e-12);
    }
    EXPECT_EQ(plan.model.led[0].by[0].first, plan.model.led[1].by[0].first);
    EXPECT_THAT(imported.text, HasSubstr("equation_1: {each: "));
}

TEST_F(ImportingPlanes, EquationsThatAStepRemovesAreLost) {
    const std::string model = mesh_of_cubes + "*EQUATION\n2\n15,3,1.,16,3,-1.\n" + properties;
    EXPECT_THAT(
        import("*STEP\n*STATIC\n*EQUATION, REMOVE ALL\n*DSLOAD\nTop,P,1.\n*END STEP\n", DeckUnits::mm, model).lost,
        ElementsAre(HasSubstr("equations hold for the whole run")));
    for (const char* bad : {"*EQUATION\ntwo\n", "*EQUATION\n3\n15,3,1.,16,3,-1.\n", "*EQUATION\n1\n15,4,1.\n",
                            "*EQUATION\n1\nNowhere,1,1.\n", "*EQUATION\n2\nLid,3,1.,Floor,3,-1.\n"})
        EXPECT_EQ(
            import("*STEP\n*STATIC\n*DSLOAD\nTop,P,1.\n*END STEP\n", DeckUnits::mm, mesh_of_cubes + bad + properties)
                .lost.size(),
            1)
            << bad;
}

} // namespace
} // namespace osculate::deck::OSCULATE_THIS_FILE
