/// Rigid bodies of decks.

#include "deck/imported.hpp"
#include "osculate/mesh/deck_mesh.hpp"
#include "osculate/mesh/mesh_error.hpp"
#include "support/diary.hpp"

#include <gmock/gmock.h>
#include <regex>

namespace osculate::deck::OSCULATE_THIS_FILE {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// A cube of 10 mm that is held below, of E = 100 MPa and nu = 0.
const std::string cube =
    "*NODE, NSET=All\n1,0,0,0\n2,10,0,0\n3,10,10,0\n4,0,10,0\n5,0,0,10\n6,10,0,10\n7,10,10,10\n8,0,10,10\n"
    "*ELEMENT, TYPE=C3D8, ELSET=Cube\n1,1,2,3,4,5,6,7,8\n*NSET, NSET=Floor\n1,2,3,4\n*NSET, NSET=Roof\n5,6,7,8\n"
    "*SURFACE, NAME=Up\nCube,S2\n*MATERIAL, NAME=Soft\n*ELASTIC\n100.,0.\n*SOLID SECTION, ELSET=Cube, MATERIAL=Soft\n"
    "*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n*BOUNDARY\nFloor,1,3\nRoof,1,2\n";
const std::string pair = "*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE\nUp,Tool\n";
/// A plate of four facets on its roof, whose nodes go about upward; its reference node is 100.
const std::string facets =
    "*NODE\n11,-5,-5,10\n12,5,-5,10\n13,15,-5,10\n14,-5,5,10\n15,5,5,10\n16,15,5,10\n17,-5,15,10\n"
    "18,5,15,10\n19,15,15,10\n100,5,5,40\n"
    "*ELEMENT, TYPE=R3D4, ELSET=Plate\n11,11,12,15,14\n12,12,13,16,15\n13,14,15,18,17\n14,15,16,19,18\n";
const std::string plate = facets + "*SURFACE, NAME=Tool\nPlate,SNEG\n*RIGID BODY, REF NODE=100, ELSET=Plate\n";
/// The same as a solid.
const std::string block = "*NODE\n11,-5,-5,10\n12,15,-5,10\n13,15,15,10\n14,-5,15,10\n15,-5,-5,20\n16,15,-5,20\n"
                          "17,15,15,20\n18,-5,15,20\n100,5,5,40\n*ELEMENT, TYPE=C3D8, ELSET=Plate\n"
                          "11,11,12,13,14,15,16,17,18\n*SURFACE, NAME=Tool\nPlate,S1\n"
                          "*RIGID BODY, ELSET=Plate, REF NODE=100\n";

std::string pressed(const std::string& more = "") {
    return "*STEP\n*STATIC\n.5,1.\n*BOUNDARY\n100,1,2\n100,3,3,-.1\n100,4,6\n" + more + "*END STEP\n";
}

class ImportingRigidBodies : public Imports {
protected:
    ImportedScene with(const std::string& tool, const std::string& steps = pressed(),
                       const std::string& contact = pair) const {
        return import(steps, DeckUnits::mm, cube + tool + contact);
    }
};

const scene::Body& tool_of(const scene::Scene& scene) {
    return scene.bodies.at(1).second;
}

TEST_F(ImportingRigidBodies, FacetsAndSolidsPressAsTheDeckHasIt) {
    for (const std::string& tool : {plate, block}) {
        const ImportedScene imported = with(tool);
        EXPECT_THAT(imported.lost, IsEmpty());
        const scene::Scene scene = checked(imported);
        ASSERT_TRUE(tool_of(scene).rigid);
        EXPECT_EQ(tool_of(scene).rigid->fixed, (std::array{true, true, false, true, true, true}));
        EXPECT_LT((*tool_of(scene).rigid->reference_point - Vec3(.005, .005, .04)).norm(), 1e-15);
        app::Plan plan = support::compiled(scene);
        const support::Diary diary = support::diary_of(plan);
        ASSERT_FALSE(diary.states.empty());
        ASSERT_THAT(diary.states.back().contact, SizeIs(1));
        Vec3 force = Vec3::Zero();
        for (const Vec3& f : diary.states.back().contact[0].lambda) force += f;
        EXPECT_NEAR(force.norm(), 100, 1e-4) << "E A u / h";
    }
}

TEST_F(ImportingRigidBodies, TheLayerOfFacetsIsBehindTheSideThatTouches) {
    const auto mesh_of = [&](const std::string& side) {
        std::string tool = plate;
        tool.replace(tool.find("SNEG"), 4, side);
        return app::build_meshes(scene::parse_scene(with(tool).text, "imported.yaml")).at(1);
    };
    for (const auto& [side, sign] : {std::pair<const char*, double>{"SNEG", -1}, {"spos", 1}}) {
        const mesh::Mesh mesh = mesh_of(side);
        ASSERT_EQ(mesh.element_count(), 4);
        ASSERT_THAT(mesh.surfaces.at("Tool"), SizeIs(4));
        for (const mesh::Facet& facet : mesh.surfaces.at("Tool")) {
            EXPECT_NEAR((mesh::facet_normal(facet, mesh.nodes) - Vec3(0, 0, sign)).norm(), 0, 1e-12);
            for (const Index n : facet) EXPECT_NEAR(mesh.nodes[n][2], .01, 1e-15) << "where the deck has its nodes";
        }
        for (const Vec3& x : mesh.nodes)
            EXPECT_TRUE(std::abs(x[2] - .01) < 1e-12 || std::abs(x[2] - (.01 - sign * .0025)) < 1e-12) << x[2];
    }
}

TEST_F(ImportingRigidBodies, SetsOfTheNodesOfFacetsAreThoseOfTheDeck) {
    const std::string model = cube + plate + "*NSET, NSET=Corners, ELSET=Plate\n" + pair;
    std::ofstream(path) << model;
    const mesh::DeckMesh read = mesh::read_deck_mesh(mesh::read_deck(path));
    EXPECT_THAT(read.raw.node_sets.at("Corners"), SizeIs(9));
    for (const Index p : read.raw.node_sets.at("Corners")) EXPECT_GE(p, 0);
    EXPECT_THAT(import(pressed(), DeckUnits::mm, model).lost, IsEmpty());
}

TEST_F(ImportingRigidBodies, MotionsForcesAndMomentsKeepTheirStepsAndUnits) {
    const ImportedScene imported =
        with(block, "*AMPLITUDE, NAME=Up\n0.,0.,1.,1.\n*STEP\n*STATIC\n.5,1.\n*BOUNDARY\n100,ENCASTRE\n*END STEP\n"
                    "*STEP\n*STATIC\n*BOUNDARY\n100,3,3,-.1\n*BOUNDARY, AMPLITUDE=Up\n100,6,6,.5\n*END STEP\n");
    EXPECT_THAT(imported.lost, IsEmpty());
    const scene::Scene scene = checked(imported);
    EXPECT_EQ(tool_of(scene).rigid->fixed, (std::array{true, true, false, true, true, false}));
    const auto& motion = scene::find(scene.stages.at(1).second.motion, scene.bodies[1].first);
    ASSERT_NE(motion, nullptr);
    EXPECT_NEAR((*motion)[2]->value(), -1e-4, 1e-18);
    EXPECT_NEAR((*motion)[5]->function()(1.0), .5, 1e-15) << "rad, without a unit of length";
    const ImportedScene loaded =
        with(block, "*STEP\n*STATIC\n1.,1.\n*BOUNDARY\n100,1,2\n100,4,6\n*CLOAD\n100,3,-7.\n100,5,20.\n*END STEP\n");
    EXPECT_THAT(loaded.lost, IsEmpty());
    const scene::Stage stage = checked(loaded).stages.at(0).second;
    ASSERT_THAT(stage.force, SizeIs(1));
    EXPECT_DOUBLE_EQ(stage.force[0].second[2].value(), -7);
    ASSERT_THAT(stage.moment, SizeIs(1));
    EXPECT_DOUBLE_EQ(stage.moment[0].second[1].value(), .02) << "N m";
}

TEST_F(ImportingRigidBodies, OfPartsTurnWithTheirInstance) {
    const std::string part =
        "*Part, name=Tool\n*Node\n1,0,0,0\n2,20,0,0\n3,20,20,0\n4,0,20,0\n9,10,10,-30\n"
        "*Element, type=R3D4\n1,1,2,3,4\n*Elset, elset=All\n1\n*Nset, nset=Tool-RefPt_, internal\n9\n"
        "*Surface, type=ELEMENT, name=Side\nAll, SPOS\n*End Part\n";
    std::string mesh = cube.substr(0, cube.find("*MATERIAL")) + "*SOLID SECTION, ELSET=Cube, MATERIAL=Soft\n";
    std::string rest = cube.substr(cube.find("*MATERIAL"));
    rest.erase(rest.find("*SOLID SECTION"), std::string("*SOLID SECTION, ELSET=Cube, MATERIAL=Soft\n").size());
    rest.replace(rest.find("Floor"), 5, "Cube-1.Floor");
    rest.replace(rest.find("Roof"), 4, "Cube-1.Roof");
    // upside down, above the cube: turned about the line along x through (0, 5, 10)
    const std::string deck = part + "*Part, name=Cube\n" + mesh +
                             "*End Part\n*Assembly, name=Assembly\n*Instance, name=Cube-1, part=Cube\n*End Instance\n"
                             "*Instance, name=Tool-1, part=Tool\n-5.,-5.,10.\n0.,5.,10.,1.,5.,10.,180.\n*End Instance\n"
                             "*Rigid Body, ref node=Tool-1.Tool-RefPt_, elset=Tool-1.All\n*End Assembly\n" +
                             rest +
                             "*Contact Pair, interaction=I, type=SURFACE TO SURFACE\nCube-1.Up, Tool-1.Side\n"
                             "*Boundary\nTool-1.Tool-RefPt_, 1, 2\nTool-1.Tool-RefPt_, 4, 6\n"
                             "*Step\n*Static\n1., 1.\n*Boundary\nTool-1.9, 3, 3, -0.1\n*End Step\n";
    const ImportedScene imported = import("", DeckUnits::mm, deck);
    EXPECT_THAT(imported.lost, IsEmpty());
    const scene::Scene scene = checked(imported);
    const auto* tool = scene::find(scene.bodies, "Tool-1");
    ASSERT_TRUE(tool != nullptr && tool->rigid);
    EXPECT_LT((*tool->rigid->reference_point - Vec3(.005, .005, .04)).norm(), 1e-12);
    app::Plan plan = support::compiled(scene);
    const support::Diary diary = support::diary_of(plan);
    Vec3 force = Vec3::Zero();
    for (const Vec3& f : diary.states.back().contact.at(0).lambda) force += f;
    EXPECT_NEAR(force.norm(), 100, 1e-4);
}

TEST_F(ImportingRigidBodies, InGeneralContactTwoOfThemPassThroughEachOther) {
    const std::string second =
        "*NODE\n31,-5,-5,60\n32,15,-5,60\n33,15,15,60\n34,-5,15,60\n35,-5,-5,70\n36,15,-5,70\n"
        "37,15,15,70\n38,-5,15,70\n200,5,5,90\n*ELEMENT, TYPE=C3D8, ELSET=Other\n"
        "31,31,32,33,34,35,36,37,38\n*RIGID BODY, REF NODE=200, ELSET=Other\n*BOUNDARY\n200,1,6\n";
    const ImportedScene imported = with(block + second, pressed(), "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n");
    EXPECT_THAT(imported.lost, IsEmpty());
    EXPECT_THAT(imported.notes, Contains(HasSubstr("two rigid bodies do not meet")));
    const scene::Scene scene = checked(imported);
    ASSERT_THAT(scene.general->pairs, SizeIs(1));
    EXPECT_FALSE(scene.general->pairs[0].second.contact);
}

TEST_F(ImportingRigidBodies, WhatHasNoCounterpartIsLost) {
    const auto swapped = [](std::string text, const std::string& from, const std::string& to) {
        return text.replace(text.find(from), from.size(), to);
    };
    const std::string card = "*RIGID BODY, ELSET=Plate, REF NODE=100";
    EXPECT_THAT(with(swapped(block, card, card + ", PIN NSET=Roof")).lost,
                Contains(HasSubstr("PINNSET has no counterpart")));
    EXPECT_THAT(with(swapped(block, card, card + ", POSITION=CENTER OF MASS")).lost,
                Contains(HasSubstr("POSITION=CENTER OF MASS")));
    EXPECT_THAT(with(swapped(block, card, "*RIGID BODY, NSET=Nowhere, REF NODE=100")).lost,
                Contains(HasSubstr("no node set 'Nowhere'")));
    EXPECT_THAT(with(swapped(block, card, "*RIGID BODY, ELSET=Plate, REF NODE=All")).lost,
                Contains(HasSubstr("REF NODE=All is not one node")));
    EXPECT_THAT(with(block + card + "\n").lost, Contains(HasSubstr("another *RIGID BODY or *COUPLING has the same")));
    EXPECT_THAT(with(facets + "*SURFACE, NAME=Tool\nPlate,SNEG\n").lost, Contains(HasSubstr("without a *RIGID BODY")));
    EXPECT_THAT(with(block, pressed("*BOUNDARY\n11,1,1\n")).lost,
                Contains(AllOf(HasSubstr("*BOUNDARY on 1 nodes of rigid bodies"), HasSubstr(".inp:"))));
    EXPECT_THAT(with(block, pressed("*CLOAD\n11,1,3.\n")).lost,
                Contains(HasSubstr("*CLOAD on 1 nodes of rigid bodies")));
    EXPECT_THAT(with(block, pressed() + "*STEP\n*STATIC\n*BOUNDARY, OP=NEW\n100,1,2\n*END STEP\n").lost,
                Contains(HasSubstr("lets go of z of a rigid body")));
    EXPECT_THAT(with(block + "*TRANSFORM, NSET=Ref, TYPE=R\n0,1,0,-1,0,0\n*NSET, NSET=Ref\n100\n").lost,
                Contains(HasSubstr("a reference node with a *TRANSFORM")));
    EXPECT_THAT(with(block, "*STEP\n*DYNAMIC\n.5,1.\n*BOUNDARY\n100,1,6\n*END STEP\n").lost,
                Contains(HasSubstr("dynamics need its mass")));
    EXPECT_THAT(with("*RIGID BODY, REF NODE=5, ELSET=Cube\n" + block).lost,
                Contains(HasSubstr("two rigid bodies do not meet")));
}

/// The cube alone, whose roof is free, with a point above it.
std::string hung(const std::string& cards, const std::string& step) {
    std::string text = cube.substr(0, cube.find("*SURFACE INTERACTION")) + "*BOUNDARY\nFloor,1,3\n";
    return text + "*NODE, NSET=Ref\n100,5,5,40\n101,5,5,40\n" + cards + "*STEP\n*STATIC\n1.,1.\n" + step +
           "*END STEP\n";
}

TEST_F(ImportingRigidBodies, CouplingsLeadAndLoadTheirNodes) {
    const auto imported = [&](const std::string& cards, const std::string& step) {
        return import("", DeckUnits::mm, hung(cards, step));
    };
    const std::string moved = "*BOUNDARY\n100,1,2\n100,3,3,-.1\n100,4,6\n", forced = "*CLOAD\n100,3,-7.\n100,5,20.\n";
    for (const char* cards : {"*COUPLING, CONSTRAINT NAME=C, REF NODE=100, SURFACE=Up\n*KINEMATIC\n1,6\n",
                              "*COUPLING, CONSTRAINT NAME=C, REF NODE=100, SURFACE=Up\n*KINEMATIC\n",
                              "*RIGID BODY, NSET=Roof, REF NODE=100\n",
                              "*COUPLING, CONSTRAINT NAME=C, REF NODE=100, SURFACE=Up\n*KINEMATIC\n1\n2\n3\n",
                              "*KINEMATIC COUPLING, REF NODE=100\nRoof,1,3\n",
                              "*KINEMATIC COUPLING, REF NODE=100\n5,1,3\n6,1,3\n7\n8,,\n"}) {
        const ImportedScene one = imported(cards, moved);
        EXPECT_THAT(one.lost, IsEmpty()) << cards;
        const scene::Scene scene = checked(one);
        ASSERT_THAT(scene.couplings, SizeIs(1)) << cards;
        const auto& [name, coupling] = scene.couplings[0];
        EXPECT_EQ(coupling.kind, scene::CouplingKind::rigid);
        EXPECT_EQ(coupling.fixed, (std::array{true, true, false, true, true, true}));
        EXPECT_LT((*coupling.reference_point - Vec3(.005, .005, .04)).norm(), 1e-15);
        app::Plan plan = support::compiled(scene);
        EXPECT_EQ(plan.model.rigid.at(0).nodes.size(), 4u);
        const support::Diary diary = support::diary_of(plan);
        for (const Index n : plan.model.rigid[0].nodes)
            EXPECT_NEAR(diary.states.back().u[static_cast<std::size_t>(n)].z(), -1e-4, 1e-15);
        const scene::Stage stage = checked(imported(cards, forced)).stages.at(0).second;
        ASSERT_THAT(stage.force, SizeIs(1)) << cards;
        EXPECT_DOUBLE_EQ(stage.force[0].second[2].value(), -7);
        EXPECT_DOUBLE_EQ(stage.moment.at(0).second[1].value(), .02) << "N m";
    }
    const std::string shared = "*COUPLING, CONSTRAINT NAME=C, REF NODE=100, SURFACE=Up\n*DISTRIBUTING\n1,6\n";
    const ImportedScene loads = imported(shared, forced);
    EXPECT_THAT(loads.lost, IsEmpty());
    EXPECT_EQ(checked(loads).couplings.at(0).second.kind, scene::CouplingKind::distributing);
    EXPECT_THAT(
        import("", DeckUnits::mm, std::regex_replace(hung(shared, forced), std::regex("\\*STEP"), "*STEP, NLGEOM"))
            .lost,
        Contains(HasSubstr("with NLGEOM")));
    EXPECT_THAT(imported(shared, moved).lost, Contains(HasSubstr("has forces and moments alone")));
}

TEST_F(ImportingRigidBodies, ANodeOfRotationsTurnsTheOther) {
    const std::string cards = "*RIGID BODY, NSET=Roof, REF NODE=100, ROT NODE=101\n";
    const scene::Scene scene =
        checked(import("", DeckUnits::mm, hung(cards, "*BOUNDARY\n100,1,3\n101,1,2\n101,3,3,.01\n")));
    EXPECT_EQ(scene.couplings.at(0).second.fixed, (std::array{true, true, true, true, true, false}));
    EXPECT_EQ((*scene::find(scene.stages.at(0).second.motion, scene.couplings[0].first))[5]->value(), .01);
    const scene::Stage loaded =
        checked(import("", DeckUnits::mm, hung(cards, "*CLOAD\n101,3,50.\n"))).stages.at(0).second;
    EXPECT_DOUBLE_EQ(loaded.moment.at(0).second[2].value(), .05);
    EXPECT_THAT(loaded.force, IsEmpty());
}

TEST_F(ImportingRigidBodies, CouplingsOfLessAreLost) {
    const std::string coupling = "*COUPLING, CONSTRAINT NAME=C, REF NODE=100, SURFACE=Up",
                      moved = "*BOUNDARY\n100,1,3\n";
    const auto lost = [&](const std::string& cards, const std::string& step) {
        return import("", DeckUnits::mm, hung(cards, step)).lost;
    };
    EXPECT_THAT(lost(coupling + "\n*KINEMATIC\n1,2\n", moved), Contains(HasSubstr("all displacements")));
    EXPECT_THAT(lost(coupling + "\n", moved), Contains(HasSubstr("*KINEMATIC or *DISTRIBUTING is expected")));
    EXPECT_THAT(lost(coupling + ", ORIENTATION=O\n*KINEMATIC\n", moved), Contains(HasSubstr("ORIENTATION")));
    EXPECT_THAT(lost(coupling + "\n*DISTRIBUTING, WEIGHTING METHOD=CUBIC\n", moved), Contains(HasSubstr("CUBIC")));
    EXPECT_THAT(lost(coupling + "\n*DISTRIBUTING\n1,3\n", "*CLOAD\n100,3,-7.\n"),
                Contains(HasSubstr("passes on no moments")));
    EXPECT_THAT(lost("*KINEMATIC COUPLING, REF NODE=100\nRoof,1,1\n", moved), Contains(HasSubstr("all displacements")));
    EXPECT_THAT(lost("*RIGID BODY, NSET=Ref, REF NODE=100\n", moved), Contains(HasSubstr("no element has its nodes")));
    EXPECT_THAT(lost("*KINEMATIC\n1,3\n", moved), Contains(HasSubstr("*KINEMATIC")));
}

TEST_F(ImportingRigidBodies, HaveNoWeightWithoutADensityAndAreNotTied) {
    std::string heavy = cube;
    heavy.insert(heavy.find("*ELASTIC"), "*DENSITY\n1E-9\n");
    const ImportedScene imported =
        import(pressed("*DLOAD\n,GRAV,9810.,0.,0.,-1.\n"), DeckUnits::mm, heavy + plate + pair);
    EXPECT_THAT(imported.lost, IsEmpty());
    EXPECT_THAT(imported.notes, Contains(HasSubstr("GRAV on rigid body Plate")));
    const auto gravity = checked(imported).stages.at(0).second.body_force;
    ASSERT_THAT(gravity, SizeIs(1)) << "the cube's, in a load on all elements";
    EXPECT_EQ(gravity[0].first, "Cube");
    EXPECT_THAT(with(plate, pressed(), pair + "*TIE, NAME=T\nUp,Tool\n").lost,
                Contains(HasSubstr("tie of UP and TOOL")));
}

TEST_F(ImportingRigidBodies, FacetsHaveOneOutside) {
    EXPECT_THROW(with(plate + "*SURFACE, NAME=Other\nPlate,SPOS\n"), mesh::MeshError);
    EXPECT_THROW(with(plate + "*SURFACE, NAME=Other\nPlate\n"), mesh::MeshError);
    EXPECT_THROW(with(plate + "*SURFACE, NAME=Other\nPlate,S1\n"), mesh::MeshError);
}

} // namespace
} // namespace osculate::deck::OSCULATE_THIS_FILE
