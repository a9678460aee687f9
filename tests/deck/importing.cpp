#include "deck/imported.hpp"
#include "osculate/core/error.hpp"
#include "osculate/deck/import_deck.hpp"
#include "osculate/mesh/mesh_error.hpp"
#include "osculate/scene/reader.hpp"

#include <gmock/gmock.h>

namespace osculate::deck::OSCULATE_THIS_FILE {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;
using ::testing::SizeIs;
using ::testing::UnorderedElementsAre;

class Importing : public Imports {};

/// The properties with more of their material.
std::string before_elastic(const std::string& more) {
    std::string text = properties;
    return text.insert(text.find("*ELASTIC"), more);
}

TEST_F(Importing, MakesABodyOfEveryPieceInSi) {
    const scene::Scene scene = checked(import(pressed));
    ASSERT_EQ(scene.bodies.size(), 2u);
    EXPECT_EQ(scene.bodies[0].first, "Eall_1");
    EXPECT_EQ(std::get<scene::FileMesh>(scene.bodies[1].second.mesh.source).piece, 2);
    EXPECT_EQ(scene.bodies[0].second.mesh.placement.scale, 1e-3);
    const auto& material = std::get<scene::LinearElastic>(scene.bodies[0].second.material);
    EXPECT_DOUBLE_EQ(material.E, 210e9);
    EXPECT_DOUBLE_EQ(material.density, 7800);
    EXPECT_EQ(app::build_meshes(scene)[1].nodes.front(), Vec3(0.01, 0.01, 0.04));
}

TEST_F(Importing, TranslatesContactSupportsAndLoads) {
    const ImportedScene imported = import(pressed);
    const scene::Scene scene = checked(imported);
    ASSERT_EQ(scene.contact.size(), 1u);
    EXPECT_EQ(scene.contact[0].second.friction, 0.25);
    EXPECT_EQ(scene.contact[0].second.discretisation, std::nullopt);
    ASSERT_TRUE(scene::find(scene.supports, "Floor") != nullptr && scene::find(scene.supports, "Lid") != nullptr);
    EXPECT_EQ(scene::find(scene.supports, "Floor")->fixed, (std::array{true, true, true}));
    EXPECT_EQ(scene::find(scene.supports, "Lid")->fixed, (std::array{true, true, false}));
    const scene::Stage& stage = scene.stages.at(0).second;
    EXPECT_EQ(stage.steps, 4);
    EXPECT_EQ(scene::find(stage.pressure, "Top")->value(), 5e6);
    EXPECT_THAT(imported.left_out, AllOf(Not(Contains(HasSubstr("*SURFACE BEHAVIOR"))),
                                         Not(Contains(HasSubstr("*FRICTION"))), Contains(HasSubstr("*NODE PRINT"))));
    for (const std::string& line : imported.left_out) EXPECT_THAT(imported.text, HasSubstr("#   " + line));
}

TEST_F(Importing, ForcesOnNodesKeepTheirNodes) {
    const scene::Scene scene = checked(import("*STEP\n*STATIC\n*CLOAD\nLid,3,-200\n15,1,-1\n*END STEP\n"));
    const auto& forces = scene.stages.at(0).second.nodal_force;
    ASSERT_EQ(forces.size(), 2u) << "one set for node 15, and one for the three others";
    std::size_t with_x = 0;
    for (const auto& [set, force] : forces) {
        EXPECT_EQ(force[2].value(), -200);
        with_x += force[0].value() == -1 ? 1 : 0;
    }
    EXPECT_EQ(with_x, 1u);
    const scene::Scene all = checked(import("*STEP\n*STATIC\n*CLOAD\nLid,3,-200\n*END STEP\n"));
    ASSERT_EQ(all.stages.at(0).second.nodal_force.size(), 1u);
    EXPECT_EQ(all.stages[0].second.nodal_force[0].first, "Lid");
}

TEST_F(Importing, DelaysShiftAmplitudes) {
    const scene::Scene scene = checked(import("*AMPLITUDE, NAME=Up\n0.,0.,1.,2.\n*STEP\n*STATIC\n1.,2.\n"
                                              "*CLOAD, AMPLITUDE=up, TIME DELAY=0.5\nLid,3,-1.\n*END STEP\n"));
    const auto& force = scene.stages.at(0).second.nodal_force;
    ASSERT_FALSE(force.empty());
    const auto& rows = std::get<scene::Table>(force[0].second[2].form).rows;
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_DOUBLE_EQ(rows[0][0], 0.5);
    EXPECT_DOUBLE_EQ(rows[1][0], 1.5);
}

TEST_F(Importing, TiesAndTiedPairsAreTies) {
    const ImportedScene tie = import("*TIE, NAME=T, POSITION TOLERANCE=0.5\nUnder,Over\n" + pressed);
    EXPECT_THAT(tie.lost, IsEmpty());
    const scene::Scene scene = checked(tie);
    ASSERT_EQ(scene.ties.size(), 1u);
    EXPECT_EQ(scene.ties[0].second.slave, scene.contact.at(0).second.slave);
    EXPECT_DOUBLE_EQ(scene.ties[0].second.distance.value(), 0.5e-3);
    // the pair's own law
    const ImportedScene law = import("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=TIED\n1E7\n" + pressed);
    EXPECT_THAT(law.lost, IsEmpty());
    EXPECT_THAT(law.notes, Contains(HasSubstr("the surfaces are tied exactly")));
    EXPECT_EQ(checked(law).ties.size(), 1u);
    EXPECT_TRUE(checked(law).contact.empty());
}

TEST_F(Importing, DrivenNodesFollowTheirSteps) {
    const scene::Scene scene = checked(import("*AMPLITUDE, NAME=Up\n0.,0.,1.,2.,\n2.,1.\n"
                                              "*STEP\n*STATIC\n1.,2.\n*BOUNDARY, AMPLITUDE=up\n15,3,3,-.5\n*END STEP\n"
                                              "*STEP\n*STATIC\n*BOUNDARY\n15,3,3,-.25\n*END STEP\n"));
    ASSERT_EQ(scene.stages.size(), 2u);
    const auto& first = scene.stages[0].second.displacement;
    const auto driven =
        std::find_if(first.begin(), first.end(), [](const auto& entry) { return entry.second[2].has_value(); });
    ASSERT_NE(driven, first.end());
    EXPECT_NEAR((*driven->second[2]).function()(1.0), -1e-3, 1e-15);
    EXPECT_NEAR((*scene::find(scene.stages[1].second.displacement, driven->first))[2]->value(), -0.25e-3, 1e-15);
    std::size_t fixed = 0; // the node's other components, and those of its neighbours
    for (const auto& [set, support] : scene.supports) fixed += support.fixed[0] ? 1 : 0;
    EXPECT_EQ(fixed, 3u) << "the floor, node 15 and the three others of the lid";
}

TEST_F(Importing, TheFirstStepMayDriveWhatWasHeldBeforeIt) {
    const scene::Scene scene = checked(import("*STEP\n*STATIC\n*BOUNDARY\nLid,2,2,.5\n*END STEP\n"));
    EXPECT_EQ(scene::find(scene.supports, "Lid")->fixed, (std::array{true, false, false}));
    EXPECT_NEAR((*scene::find(scene.stages.at(0).second.displacement, "Lid"))[1]->value(), .5e-3, 1e-15);
}

TEST_F(Importing, LargeStrainsAndDynamicsKeepTheirMeaning) {
    const scene::Scene scene =
        checked(import("*STEP, NLGEOM\n*STATIC\n*DLOAD\n2,P2,1.\n*END STEP\n"
                       "*STEP\n*DYNAMIC, ALPHA=-.1\n.1,1.\n*DLOAD\nEall,GRAV,9810.,0.,0.,-1.\n*END STEP\n"));
    EXPECT_TRUE(std::holds_alternative<scene::SaintVenantKirchhoff>(scene.bodies[0].second.material));
    EXPECT_EQ(scene.stages.at(0).second.follower_pressure.size(), 1u);
    const auto* dynamic = std::get_if<scene::DynamicAnalysis>(&scene.stages.at(1).second.analysis);
    ASSERT_NE(dynamic, nullptr);
    EXPECT_EQ(std::get<scene::Hht>(dynamic->integrator).alpha, -0.1);
    EXPECT_FALSE(scene.stages[1].second.ramp);
    EXPECT_EQ(scene.stages[1].second.control.step_size, scene::StepSize::controlled);
    const auto direct =
        checked(import("*STEP\n*DYNAMIC, DIRECT\n.1,1.\n*DLOAD\nEall,GRAV,9810.,0.,0.,-1.\n*END STEP\n")).stages.at(0);
    EXPECT_EQ(direct.second.control.step_size, scene::StepSize::fixed);
    EXPECT_NEAR((*scene::find(scene.stages[1].second.body_force, "Eall_1"))[2].value(), -7800 * 9.81, 1e-6);
}

TEST_F(Importing, NeoHookeanHasTheModuliOfTheDeck) {
    std::string model = mesh_of_cubes + properties;
    const std::string elastic = "*ELASTIC\n210000.,.3\n";
    model.replace(model.find(elastic), elastic.size(), "*HYPERELASTIC, NEO HOOKE\n10.,.01\n");
    const ImportedScene imported = import(pressed, DeckUnits::mm, model);
    const auto material = std::get<scene::NeoHookean>(checked(imported).bodies[0].second.material);
    EXPECT_NEAR(material.E / (2 * (1 + material.nu)), 20e6, 1e-3);
    EXPECT_NEAR(material.E / (3 * (1 - 2 * material.nu)), 200e6, 1e-2);
    EXPECT_THAT(imported.left_out, Contains(HasSubstr("volumetric part differs")));
}

TEST_F(Importing, WhatHasNoCounterpartIsListedWithItsLine) {
    const ImportedScene imported = import("*MPC\nBEAM,15,16\n\n"
                                          "*STEP\n*BUCKLE\n10\n*END STEP\n" +
                                          pressed);
    EXPECT_EQ(checked(imported).stages.size(), 1u);
    EXPECT_THAT(imported.left_out,
                AllOf(Contains(AllOf(HasSubstr(".inp:47: *MPC"), HasSubstr("only linear equations"))),
                      Contains(AllOf(HasSubstr(".inp:50: *STEP"), HasSubstr("*BUCKLE")))));
    EXPECT_EQ(imported.lost.size(), 2u) << "but neither output nor the law of overclosure is";
    EXPECT_THAT(imported.text, Not(HasSubstr("step_2")));
    EXPECT_THROW(import("*STEP\n*FREQUENCY\n10\n*END STEP\n"), mesh::MeshError);
}

TEST_F(Importing, FormulationsFollowTheElements) {
    std::string model = mesh_of_cubes + properties;
    model.replace(model.find("C3D8"), 4, "C3D8I");
    EXPECT_EQ(checked(import(pressed, DeckUnits::mm, model)).bodies[0].second.hex_formulation,
              HexFormulation::incompatible_modes);
    EXPECT_EQ(checked(import(pressed)).bodies[0].second.hex_formulation, HexFormulation::full);
    // at finite strain nothing else bends as these elements do
    EXPECT_THAT(import("*STEP, NLGEOM\n*STATIC\n*DSLOAD\nTop,P,5.\n*END STEP\n", DeckUnits::mm, model).lost,
                Contains(HasSubstr("incompatible modes are for small strain")));
}

TEST_F(Importing, PlasticBodiesHaveTheirHardeningCurve) {
    const std::string model = mesh_of_cubes + before_elastic("*PLASTIC\n200.,0.\n300.,.1\n");
    const scene::Scene scene = checked(import(pressed, DeckUnits::mm, model));
    const auto& law = std::get<scene::ElasticPlastic>(scene.bodies[0].second.material);
    const scene::Table expected{{{0, 200e6}, {0.1, 300e6}}};
    EXPECT_EQ(std::get<scene::Table>(law.yield_stress.form), expected);
}

TEST_F(Importing, LosesFlowThatNoLawHas) {
    const auto lost = [&](const std::string& more, const std::string& elastic) {
        std::string model = mesh_of_cubes + before_elastic(more);
        if (!elastic.empty()) {
            const std::string plain = "*ELASTIC\n210000.,.3\n";
            model.replace(model.find(plain), plain.size(), elastic);
        }
        return import(pressed, DeckUnits::mm, model).lost;
    };
    EXPECT_THAT(lost("*PLASTIC\n200.,0.,20.\n150.,0.,300.\n", ""), Contains(HasSubstr("depend on temperature")));
    EXPECT_THAT(lost("*PLASTIC\n200.,0.\n", "*HYPERELASTIC, NEO HOOKE\n10.,.01\n"),
                Contains(HasSubstr("only isotropic Hookean materials yield")));
}

TEST_F(Importing, TemperaturesCountFromTheInitialOnes) {
    const std::string model = mesh_of_cubes + before_elastic("*EXPANSION\n1.2E-5\n");
    const scene::Scene scene = checked(
        import("*INITIAL CONDITIONS, TYPE=TEMPERATURE\nAll,20.\n*STEP\n*STATIC\n*TEMPERATURE\nAll,100.\n*END STEP\n"
               "*STEP\n*STATIC\n*END STEP\n",
               DeckUnits::mm, model));
    EXPECT_DOUBLE_EQ(scene::elastic(scene.bodies[0].second.material).expansion, 1.2e-5);
    ASSERT_EQ(scene.stages[0].second.temperature.size(), scene.bodies.size());
    EXPECT_EQ(scene.stages[0].second.temperature[0].first, scene.bodies[0].first);
    EXPECT_DOUBLE_EQ(scene.stages[0].second.temperature[0].second.value(), 80);
    EXPECT_TRUE(scene.stages[1].second.temperature.empty()) << "it stays";
}

TEST_F(Importing, LeavesOutEigenfrequenciesAfterStatics) {
    const ImportedScene imported = import(pressed + "*STEP, PERTURBATION\n*FREQUENCY\n5\n*END STEP\n");
    EXPECT_THAT(imported.lost, IsEmpty());
    EXPECT_THAT(imported.notes, Contains(HasSubstr("eigenfrequencies are not computed")));
    EXPECT_EQ(checked(imported).stages.size(), 1u);
}

// ---- what is lost ----

TEST_F(Importing, TakesContactOfQuadraticTetrahedra) {
    const std::string mesh = "*NODE\n1,0,0,0\n2,9,0,0\n3,0,9,0\n4,0,0,9\n5,4.5,0,0\n6,4.5,4.5,0\n7,0,4.5,0\n8,0,0,4.5\n"
                             "9,4.5,0,4.5\n10,0,4.5,4.5\n11,0,0,0\n12,9,0,0\n13,0,9,0\n14,0,0,-9\n"
                             "*ELEMENT, TYPE=C3D10, ELSET=Upper\n1,1,2,3,4,5,6,7,8,9,10\n"
                             "*ELEMENT, TYPE=C3D4, ELSET=Lower\n2,11,13,12,14\n*ELSET, ELSET=Eall\nUpper,Lower\n"
                             "*NSET, NSET=Lid\n1,2,3\n*NSET, NSET=Floor\n14\n"
                             "*SURFACE, NAME=Under\n1,S1\n*SURFACE, NAME=Over\n2,S1\n";
    const ImportedScene imported = import("*STEP\n*STATIC\n*END STEP\n", DeckUnits::mm, mesh + properties);
    EXPECT_THAT(imported.lost, IsEmpty());
    EXPECT_EQ(scene::parse_scene(imported.text, "imported.yaml").contact.size(), 1u);
}

TEST_F(Importing, AxesOfTransformedNodesAreThoseOfTheirSupportsAndForces) {
    const ImportedScene imported =
        import("*NSET, NSET=Sides\n11,12,13,14\n*TRANSFORM, NSET=Lid, TYPE=C\n0.,0.,0.,0.,0.,10.\n"
               "*TRANSFORM, NSET=Sides\n0.,1.,0.,-1.,0.,0.\n*BOUNDARY\nSides,1,1\n"
               "*STEP\n*STATIC\n1.,1.\n*BOUNDARY\nLid,3,3,-1.\n*CLOAD\n11,1,50.\n*END STEP\n");
    EXPECT_THAT(imported.lost, IsEmpty());
    const scene::Scene scene = checked(imported);
    const scene::Support& lid = *scene::find(scene.supports, "Lid");
    ASSERT_TRUE(lid.cylinder);
    EXPECT_EQ(lid.cylinder->direction, Vec3(0, 0, 10));
    EXPECT_EQ(lid.fixed, (std::array{true, true, false}));
    const scene::Support& sides = *scene::find(scene.supports, "Sides");
    EXPECT_EQ(sides.axes.col(0), Vec3::UnitY());
    const auto& force = scene.stages.at(0).second.nodal_force.at(0).second;
    EXPECT_EQ(force[0].value(), 0);
    EXPECT_DOUBLE_EQ(force[1].value(), 50);
}

TEST_F(Importing, NodesOnAnAxisAreHeldInAllDirectionsAcrossIt) {
    const ImportedScene imported =
        import("*TRANSFORM, NSET=All, TYPE=C\n10.,10.,0.,10.,10.,5.\n*NSET, NSET=One\n15\n" + pressed);
    EXPECT_THAT(imported.lost, IsEmpty());
    const scene::Scene scene = checked(imported);
    int across = 0;
    for (const auto& [set, support] : scene.supports)
        across += !support.cylinder && support.fixed == std::array{true, true, false};
    EXPECT_EQ(across, 1) << imported.text;
}

TEST_F(Importing, SectorsAreCyclic) {
    const std::string ring = "*NSET, NSET=Slave\n3,4,7,8\n*NSET, NSET=Master\n1,2,5,6\n"
                             "*TIE, CYCLIC SYMMETRY, NAME=T, POSITION TOLERANCE=1.\nSlave,Master\n";
    const ImportedScene imported =
        import(ring + "*CYCLIC SYMMETRY MODEL, N=2, TIE=T\n20.,20.,0.,20.,20.,5.\n" + pressed);
    EXPECT_THAT(imported.lost, IsEmpty());
    const scene::Scene scene = checked(imported);
    ASSERT_EQ(scene.cyclic.size(), 1u);
    EXPECT_EQ(scene.cyclic[0].second.sectors, 2);
    EXPECT_EQ(scene.cyclic[0].second.axis.point, Vec3(0.02, 0.02, 0));
    EXPECT_EQ(scene.cyclic[0].second.distance, 1e-3);
    EXPECT_THAT(import(ring + pressed).lost, ElementsAre(HasSubstr("no *CYCLIC SYMMETRY MODEL")));
}

TEST_F(Importing, StepsChangeFrictionAndPairs) {
    const ImportedScene imported =
        import(pressed + "*STEP\n*STATIC\n1.,1.\n*CHANGE FRICTION, INTERACTION=I\n*FRICTION\n.1,1E6\n*END STEP\n"
                         "*STEP\n*STATIC\n1.,1.\n*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nunder,over\n*END STEP\n");
    EXPECT_THAT(imported.lost, IsEmpty());
    const scene::Scene scene = scene::parse_scene(imported.text, "imported.yaml");
    const std::string& pair = scene.contact.at(0).first;
    EXPECT_EQ(*scene::find(scene.stages.at(1).second.friction, pair), 0.1);
    EXPECT_EQ(*scene::find(scene.stages.at(2).second.pairs, pair), false);
    EXPECT_THAT(import("*STEP\n*STATIC\n1.,1.\n*FRICTION\n.1\n*END STEP\n").lost,
                ElementsAre(HasSubstr("no *CHANGE FRICTION stands before it")));
    EXPECT_THAT(import("*STEP\n*STATIC\n1.,1.\n*MODEL CHANGE, TYPE=CONTACT PAIR, REMOVE\nover,under\n*END STEP\n").lost,
                ElementsAre(HasSubstr("*MODEL CHANGE of OVER and UNDER: no such pair slides")));
    EXPECT_THAT(import("*STEP\n*STATIC\n1.,1.\n*MODEL CHANGE, TYPE=ELEMENT, REMOVE\nEall\n*END STEP\n").lost,
                SizeIs(1));
}

TEST_F(Importing, DampingOfAllBodiesIsThatOfDynamicStages) {
    const std::string dynamic = "*STEP\n*DYNAMIC\n.01,1.\n*END STEP\n";
    const auto with = [&](const std::string& card, const std::string& steps) {
        return import(steps, DeckUnits::mm, mesh_of_cubes + before_elastic(card));
    };
    const ImportedScene damped = with("*DAMPING, ALPHA=5., BETA=2e-4\n", dynamic);
    EXPECT_THAT(damped.lost, IsEmpty());
    const scene::Scene scene = scene::parse_scene(damped.text, "imported.yaml");
    const auto& analysis = std::get<scene::DynamicAnalysis>(scene.stages.at(0).second.analysis);
    EXPECT_EQ(analysis.mass_damping, 5);
    EXPECT_EQ(analysis.stiffness_damping, 2e-4);
    EXPECT_THAT(with("*DAMPING, ALPHA=5.\n", pressed).lost, IsEmpty());
    EXPECT_THAT(with("*DAMPING, ALPHA=-5.\n", dynamic).lost, SizeIs(1));
    EXPECT_THAT(with("*DAMPING, STRUCTURAL=.1\n", dynamic).lost, SizeIs(1));
}

/// As CalculiX reads it.
TEST_F(Importing, ASecondDefinitionExtendsASurface) {
    const std::string steps = "*SURFACE, NAME=Top\n2,S2\n2,S3\n" + pressed;
    const scene::Scene scene = checked(import(steps));
    for (const model::Set& set : plan_of(scene).model.sets)
        EXPECT_EQ(set.facets.size(), set.name == "Top" ? 2u : set.facets.size());
}

TEST_F(Importing, AdjustingASetOfNodesTakesAllSlaves) {
    const auto with = [&](const std::string& nodes) {
        std::string model = mesh_of_cubes + "*NSET, NSET=Moved\n" + nodes + "\n" + properties;
        model.insert(model.find(", TYPE=SURFACE TO"), ", ADJUST=Moved");
        return import(pressed, DeckUnits::mm, model);
    };
    EXPECT_THAT(with("11,12,13,14").lost, IsEmpty());
    EXPECT_GT(checked(with("11,12,13,14")).contact.at(0).second.adjust.value_or(0), 0.02);
    EXPECT_THAT(with("11,12").lost, ElementsAre(HasSubstr("a set with all slave nodes")));
}

TEST_F(Importing, TellsWhatIsLostFromWhatBodiesDoWithout) {
    const auto lost = [&](const std::string& model_data) { return import(model_data + pressed).lost; };
    EXPECT_THAT(lost(""), IsEmpty());
    for (const char* card : {"*TIE, CYCLIC SYMMETRY, NAME=T\nUnder,Over\n", "*TEMPERATURE\nAll,20.\n",
                             "*SPRING, ELSET=S\n\n100.\n", "*INITIAL CONDITIONS, TYPE=VELOCITY\nAll,3,-1.\n",
                             "*MATERIAL, NAME=P\n*PLASTIC, HARDENING=KINEMATIC\n100.,0.\n",
                             "*SURFACE BEHAVIOR, NO SEPARATION\n", "*BOUNDARY\nNone,1\n"})
        EXPECT_EQ(lost(card).size(), 1u) << card;
    for (const char* card : {"*RESTART, WRITE\n", "*TIME POINTS, NAME=T\n1.\n", "*CONTROLS, PARAMETERS=FIELD\n.005\n",
                             "*INITIAL CONDITIONS, TYPE=TEMPERATURE\nAll,20.\n"})
        EXPECT_THAT(lost(card), IsEmpty()) << card;
    EXPECT_THAT(import("*STEP\n*STATIC\n*DSLOAD\nNone,P,1.\n*END STEP\n").lost,
                ElementsAre(HasSubstr(".inp:50: None,P,1.: no surface of that name")));
}

TEST_F(Importing, KeywordsNeedNoBlanks) {
    std::string model = mesh_of_cubes + properties, steps = pressed;
    const auto squeeze = [](std::string& text, const std::string& keyword, const std::string& squeezed) {
        text.replace(text.find(keyword), keyword.size(), squeezed);
    };
    squeeze(model, "*SOLID SECTION", "*SOLIDSECTION");
    squeeze(model, "*SURFACE INTERACTION", "*SurfaceInteraction");
    squeeze(model, "*CONTACT PAIR", "*CONTACTPAIR");
    squeeze(steps, "*END STEP", "*ENDSTEP");
    const ImportedScene imported = import(steps, DeckUnits::mm, model);
    EXPECT_THAT(imported.lost, IsEmpty());
    EXPECT_EQ(checked(imported).contact.size(), 1u);
}

TEST_F(Importing, AScenePutsItsLossesFirst) {
    const std::string text = import("*TIE, CYCLIC SYMMETRY, NAME=T\nUnder,Over\n" + pressed).text;
    EXPECT_LT(text.find("# Lost:\n#   "), text.find("*TIE"));
    EXPECT_LT(text.find("*TIE"), text.find("# Not as in the deck:\n#   "));
}

TEST_F(Importing, NodesThatNoElementHasLoseWhatTheyCarry) {
    const std::string model = mesh_of_cubes + "*NODE, NSET=Alone\n99,0,0,90\n*NSET, NSET=Lid\n99\n" + properties;
    const ImportedScene imported =
        import("*BOUNDARY\nAlone,1,3\n*STEP\n*STATIC\n*CLOAD\nAlone,3,-5.\n*BOUNDARY\nAlone,3,3,.5\n*END STEP\n",
               DeckUnits::mm, model);
    EXPECT_THAT(imported.lost, UnorderedElementsAre(HasSubstr("*CLOAD on 1 nodes: no element has them"),
                                                    HasSubstr("*BOUNDARY on 1 nodes: no element has them")));
    EXPECT_THAT(imported.notes, Contains(HasSubstr(".inp:52: *BOUNDARY on 1 nodes"))) << "held at zero";
    (void)checked(imported);
}

TEST_F(Importing, StepsLetGoOfWhatTheyDoNotHoldAnew) {
    const std::string next = pressed + "*STEP\n*STATIC\n*BOUNDARY, OP=NEW\n";
    const auto scene_of = [&](const std::string& steps) {
        const ImportedScene imported = import(steps);
        EXPECT_THAT(imported.lost, IsEmpty());
        return checked(imported);
    };
    const scene::Scene same = scene_of(next + "Floor,1,3\nLid,1,2\n*END STEP\n");
    EXPECT_THAT(same.stages.at(1).second.release, IsEmpty()) << "all is given anew";
    const std::string let_go = "Floor,1,3\nLid,1\n*END STEP\n", again = "*STEP\n*STATIC\n*BOUNDARY, OP=NEW\n";
    const scene::Scene once = scene_of(next + let_go + again + let_go);
    EXPECT_EQ(scene::find(once.supports, "Lid")->fixed, (std::array{true, true, false}));
    EXPECT_EQ(*scene::find(once.stages.at(1).second.release, "Lid"), (std::array{false, true, false}));
    EXPECT_THAT(once.stages.at(2).second.release, IsEmpty());
    const scene::Scene back = scene_of(next + let_go + again + "Floor,1,3\nLid,1,2\n*END STEP\n");
    EXPECT_EQ(scene::find(back.supports, "Lid")->fixed, (std::array{true, false, false}));
    EXPECT_EQ(scene::find(back.stages.at(0).second.displacement, "Lid")->at(1)->value(), 0);
    EXPECT_EQ(scene::find(back.stages.at(2).second.displacement, "Lid")->at(1)->value(), 0);
}

TEST_F(Importing, OneStepOfLargeStrainsAmongOthersIsNoLawForAll) {
    const std::string small = "*STEP\n*STATIC\n*END STEP\n", large = "*STEP, NLGEOM\n*STATIC\n*END STEP\n";
    EXPECT_THAT(import(small + small + large).lost,
                ElementsAre(AllOf(HasSubstr(".inp:47: small strain of step 1"), HasSubstr("NLGEOM (3)")),
                            HasSubstr(".inp:50: small strain of step 2")));
    EXPECT_THAT(import(large + small).lost, IsEmpty()) << "it lasts";
    EXPECT_THAT(import(large + "*STEP, NLGEOM=NO\n*STATIC\n*END STEP\n").lost, SizeIs(1));
}

// ---- contact ----

TEST_F(Importing, PairsAreNamedWithAndWithoutBlanks) {
    const std::string type = "TYPE=SURFACE TO SURFACE";
    const auto pair = [&](const std::string& other) {
        std::string model = mesh_of_cubes + properties;
        model.replace(model.find(type), type.size(), other);
        const ImportedScene imported = import(pressed, DeckUnits::mm, model);
        EXPECT_THAT(imported.lost, IsEmpty()) << other;
        return checked(imported).contact.at(0).second;
    };
    for (const char* mortar :
         {"TYPE=MORTAR", "TYPE=SURFACETOSURFACE", "type=Surface to Surface", "TYPE=SURFACE  TO SURFACE"})
        EXPECT_EQ(pair(mortar).discretisation, std::nullopt) << mortar;
    for (const char* nodes : {"TYPE=NODE TO SURFACE", "TYPE=nodetosurface", "ADJUST=0."}) {
        EXPECT_EQ(pair(nodes).discretisation, Discretisation::node) << nodes;
        EXPECT_TRUE(std::holds_alternative<scene::FacetsSurface>(pair(nodes).master.surface)) << nodes;
    }
    std::string model = mesh_of_cubes + properties;
    model.replace(model.find(type), type.size(), "TYPE=SURFACE TO NODE");
    EXPECT_THAT(import(pressed, DeckUnits::mm, model).lost, ElementsAre(HasSubstr("TYPE=SURFACETONODE is not known")));
}

TEST_F(Importing, SmoothStepsRiseAsTheirPolynomial) {
    const std::string model = mesh_of_cubes + properties + "*AMPLITUDE, NAME=A, DEFINITION=SMOOTH STEP\n0,0,.5,2,1,1\n";
    const ImportedScene imported =
        import("*STEP\n*STATIC, DIRECT\n.125,1.\n*DSLOAD, AMPLITUDE=A\nTop,P,1.\n*END STEP\n", DeckUnits::mm, model);
    EXPECT_THAT(imported.lost, IsEmpty());
    const auto at = scene::find(checked(imported).stages.at(0).second.pressure, "Top")->function();
    for (const auto& [t, factor] :
         {std::pair{0.0, 0.0}, {0.125, 0.207}, {0.25, 1.0}, {0.5, 2.0}, {0.75, 1.5}, {1.0, 1.0}})
        EXPECT_NEAR(at(t), factor * 1e6, 1e6 * 4e-4) << t;
}

} // namespace
} // namespace osculate::deck::OSCULATE_THIS_FILE
