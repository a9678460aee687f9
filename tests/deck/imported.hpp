#pragma once
/// Decks that tests write, import, and read as scenes.

#include "osculate/app/compile.hpp"
#include "osculate/deck/import_deck.hpp"
#include "osculate/mesh/deck.hpp"
#include "osculate/scene/reader.hpp"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <string>

namespace osculate::deck {

/// A small cube on a large one, in millimetres, both in one element set.
inline const std::string mesh_of_cubes =
    "*NODE, NSET=All\n"
    "1,0,0,0\n2,40,0,0\n3,40,40,0\n4,0,40,0\n5,0,0,40\n6,40,0,40\n7,40,40,40\n8,0,40,40\n"
    "11,10,10,40\n12,30,10,40\n13,30,30,40\n14,10,30,40\n15,10,10,60\n16,30,10,60\n"
    "17,30,30,60\n18,10,30,60\n"
    "*ELEMENT, TYPE=C3D8, ELSET=Eall\n1,1,2,3,4,5,6,7,8\n2,11,12,13,14,15,16,17,18\n"
    "*NSET, NSET=Floor, GENERATE\n1,4\n*NSET, NSET=Lid\n15,16,17,18\n"
    "*SURFACE, NAME=Under\n2,S1\n*SURFACE, NAME=Over\n1,S2\n*SURFACE, NAME=Top\n2,S2\n";
inline const std::string properties =
    "*MATERIAL, NAME=Steel\n*ELASTIC\n210000.,.3\n*DENSITY\n7.8E-9\n"
    "*SOLID SECTION, ELSET=EALL, MATERIAL=steel\n"
    "*SURFACE INTERACTION, NAME=I\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1E7\n"
    "*FRICTION\n.25,1E6\n"
    "*CONTACT PAIR, INTERACTION=i, TYPE=SURFACE TO SURFACE\nunder,over\n"
    "*BOUNDARY\nFloor,1,3\nLid,1,2\n";
inline const std::string pressed =
    "*STEP\n*STATIC, DIRECT\n.25,1.\n*DSLOAD\nTop,P,5.\n*NODE PRINT, NSET=All\nU\n*END STEP\n";

class Imports : public ::testing::Test {
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

    static app::Plan plan_of(const scene::Scene& scene) {
        Timings timings;
        return app::compile(scene, app::build_meshes(scene), 1, timings);
    }

    /// As `osculate check` reads it: it must be fit to run.
    static scene::Scene checked(const ImportedScene& imported) {
        scene::Scene scene = scene::parse_scene(imported.text, "imported.yaml");
        (void)plan_of(scene);
        return scene;
    }
};

} // namespace osculate::deck
