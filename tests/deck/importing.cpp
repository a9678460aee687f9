#include "osculate/app/compile.hpp"
#include "osculate/core/error.hpp"
#include "osculate/deck/import_deck.hpp"
#include "osculate/mesh/generators.hpp"
#include "osculate/mesh/mesh_error.hpp"
#include "osculate/mesh/surface_faces.hpp"
#include "osculate/scene/reader.hpp"

#include <filesystem>
#include <fstream>
#include <gmock/gmock.h>
#include <map>

namespace osculate::deck {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

/// A small cube on a large one, in millimetres, both in one element set.
const std::string mesh_of_cubes = "*NODE, NSET=All\n"
                                  "1,0,0,0\n2,40,0,0\n3,40,40,0\n4,0,40,0\n5,0,0,40\n6,40,0,40\n7,40,40,40\n8,0,40,40\n"
                                  "11,10,10,40\n12,30,10,40\n13,30,30,40\n14,10,30,40\n15,10,10,60\n16,30,10,60\n"
                                  "17,30,30,60\n18,10,30,60\n"
                                  "*ELEMENT, TYPE=C3D8, ELSET=Eall\n1,1,2,3,4,5,6,7,8\n2,11,12,13,14,15,16,17,18\n"
                                  "*NSET, NSET=Floor, GENERATE\n1,4\n*NSET, NSET=Lid\n15,16,17,18\n"
                                  "*SURFACE, NAME=Under\n2,S1\n*SURFACE, NAME=Over\n1,S2\n*SURFACE, NAME=Top\n2,S2\n";
const std::string properties = "*MATERIAL, NAME=Steel\n*ELASTIC\n210000.,.3\n*DENSITY\n7.8E-9\n"
                               "*SOLID SECTION, ELSET=EALL, MATERIAL=steel\n"
                               "*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1E7\n"
                               "*FRICTION\n.25,1E6\n"
                               "*CONTACT PAIR, INTERACTION=i, TYPE=SURFACE TO SURFACE\nunder,over\n"
                               "*BOUNDARY\nFloor,1,3\nLid,1,2\n";

class Importing : public ::testing::Test {
protected:
    std::filesystem::path path =
        std::filesystem::path(::testing::TempDir()) /
        (std::string("osculate_") + ::testing::UnitTest::GetInstance()->current_test_info()->name() + ".inp");
    void TearDown() override { std::filesystem::remove(path); }

    ImportedScene import(const std::string& steps, DeckUnits units = DeckUnits::mm,
                         const std::string& model = mesh_of_cubes + properties) const {
        std::ofstream(path) << model << steps;
        return import_deck(mesh::read_deck(path), path.string(), units);
    }

    /// As `osculate check` reads it: it must be fit to run.
    static scene::Scene checked(const ImportedScene& imported) {
        scene::Scene scene = scene::parse_scene(imported.text, "imported.yaml");
        Timings timings;
        (void)app::compile(scene, app::build_meshes(scene), 1, timings);
        return scene;
    }
};

const std::string pressed = "*STEP\n*STATIC, DIRECT\n.25,1.\n*DSLOAD\nTop,P,5.\n*NODE PRINT, NSET=All\nU\n*END STEP\n";

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
    EXPECT_EQ(scene.contact[0].second.discretisation, scene::Discretisation::mortar);
    ASSERT_TRUE(scene::find(scene.supports, "Floor") != nullptr && scene::find(scene.supports, "Lid") != nullptr);
    EXPECT_EQ(scene::find(scene.supports, "Floor")->fixed, (std::array{true, true, true}));
    EXPECT_EQ(scene::find(scene.supports, "Lid")->fixed, (std::array{true, true, false}));
    const scene::Stage& stage = scene.stages.at(0).second;
    EXPECT_EQ(stage.steps, 4);
    EXPECT_EQ(scene::find(stage.pressure, "Top")->value(), 5e6);
    EXPECT_THAT(imported.left_out,
                AllOf(Contains(HasSubstr(":38: *SURFACE BEHAVIOR")),
                      Contains(HasSubstr(":40: *FRICTION: its stick slope")), Contains(HasSubstr("*NODE PRINT"))));
    for (const std::string& line : imported.left_out) EXPECT_THAT(imported.text, HasSubstr("#   " + line));
}

TEST_F(Importing, ForcesOnNodesAreThePressureThatTheyAreOf) {
    // 2 MPa on 20 mm x 20 mm
    const scene::Scene scene = checked(import("*STEP\n*STATIC\n*CLOAD\nLid,3,-200\n*END STEP\n"));
    ASSERT_NE(scene::find(scene.stages.at(0).second.pressure, "Top"), nullptr) << "which has the facets";
    EXPECT_NEAR(scene::find(scene.stages.at(0).second.pressure, "Top")->value(), 2e6, 1e-3);
    const ImportedScene uneven = import("*STEP\n*STATIC\n*CLOAD\nLid,3,-200\n15,3,-1\n*END STEP\n");
    EXPECT_TRUE(scene::parse_scene(uneven.text, "uneven.yaml").stages.at(0).second.pressure.empty());
    EXPECT_THAT(uneven.left_out, Contains(AllOf(HasSubstr("*CLOAD on 4 nodes"), HasSubstr("one pressure"))));
}

/// A block of ten-node tetrahedra, 2 mm each way, standing on its floor; its nodes as Lid, Floor, All.
std::string deck_of_tet10s(const mesh::Mesh& block) {
    std::string text = "*NODE, NSET=All\n", lid = "*NSET, NSET=Lid\n", floor = "*NSET, NSET=Floor\n";
    for (Index n = 0; n < block.node_count(); ++n) {
        const Vec3& X = block.nodes[n];
        const std::string id = std::to_string(n + 1);
        text += id + "," + std::to_string(X.x()) + "," + std::to_string(X.y()) + "," + std::to_string(X.z()) + "\n";
        if (X.z() == 2) lid += id + ",\n";
        if (X.z() == 0) floor += id + ",\n";
    }
    text += "*ELEMENT, TYPE=C3D10, ELSET=E\n";
    for (Index e = 0; e < block.blocks[0].size(); ++e) {
        text += std::to_string(e + 1);
        for (std::size_t a = 0; a < 10; ++a)
            text += "," + std::to_string(block.blocks[0].connectivity[10 * static_cast<std::size_t>(e) + a] + 1);
        text += "\n";
    }
    return text + lid + floor +
           "*MATERIAL, NAME=M\n*ELASTIC\n210000.,.3\n*SOLID SECTION, ELSET=E, MATERIAL=M\n"
           "*BOUNDARY\nFloor,1,3\n";
}

TEST_F(Importing, ForcesOnSixNodeFacesAreThoseOfAPressureOnNodesMidwayAlone) {
    // 3 MPa on two triangles of 2 mm^2: 2 N on every node midway, twice where both meet, and nothing on corners
    const mesh::Mesh block = mesh::make_block({0, 0, 0}, {2, 2, 2}, {1, 1, 1}, mesh::CellType::tet10);
    std::map<Index, double> force;
    for (const mesh::SurfaceFace& face : mesh::surface_faces(block, block.surfaces.at("z_max")))
        for (std::size_t i = 3; i < 6; ++i) force[face.nodes[i]] -= 2;
    ASSERT_EQ(force.size(), 5u);
    std::string loads = "*STEP\n*STATIC\n*CLOAD\n";
    for (const auto& [node, f] : force) loads += std::to_string(node + 1) + ",3," + std::to_string(f) + "\n";
    const ImportedScene imported = import(loads + "*END STEP\n", DeckUnits::mm, deck_of_tet10s(block));
    const scene::Scene scene = checked(imported);
    ASSERT_EQ(scene.stages.at(0).second.pressure.size(), 1u) << imported.text;
    EXPECT_EQ(scene.stages[0].second.pressure[0].first, "Lid");
    EXPECT_NEAR(scene.stages[0].second.pressure[0].second.value(), 3e6, 1e-3);
    for (auto& [node, f] : force) f = -2; // as of four triangles each: no pressure does this
    loads = "*STEP\n*STATIC\n*CLOAD\n";
    for (const auto& [node, f] : force) loads += std::to_string(node + 1) + ",3," + std::to_string(f) + "\n";
    const ImportedScene uneven = import(loads + "*END STEP\n", DeckUnits::mm, deck_of_tet10s(block));
    EXPECT_TRUE(scene::parse_scene(uneven.text, "uneven.yaml").stages.at(0).second.pressure.empty());
    EXPECT_THAT(uneven.left_out, Contains(AllOf(HasSubstr("*CLOAD on 5 nodes"), HasSubstr("one pressure"))));
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
    EXPECT_EQ(fixed, 5u) << "the floor, node 15 and the three others of the lid";
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
    const ImportedScene imported = import("*EQUATION\n2\n15,3,1.,16,3,-1.\n"
                                          "*STEP\n*FREQUENCY\n10\n*END STEP\n" +
                                          pressed);
    EXPECT_EQ(checked(imported).stages.size(), 1u);
    EXPECT_THAT(imported.left_out,
                AllOf(Contains(AllOf(HasSubstr(".inp:47: *EQUATION"), HasSubstr("no equations between nodes"))),
                      Contains(AllOf(HasSubstr(".inp:50: *STEP"), HasSubstr("*FREQUENCY")))));
    EXPECT_THAT(imported.text, Not(HasSubstr("step_2")));
    EXPECT_THROW(import("*STEP\n*FREQUENCY\n10\n*END STEP\n"), mesh::MeshError);
}

TEST_F(Importing, FormulationsFollowTheElements) {
    std::string model = mesh_of_cubes + properties;
    model.replace(model.find("C3D8"), 4, "C3D8I");
    EXPECT_EQ(checked(import(pressed, DeckUnits::mm, model)).bodies[0].second.hex_formulation,
              scene::HexFormulation::incompatible_modes);
    EXPECT_EQ(checked(import(pressed)).bodies[0].second.hex_formulation, scene::HexFormulation::full);
}

} // namespace
} // namespace osculate::deck
