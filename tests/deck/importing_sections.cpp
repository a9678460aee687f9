/// Pieces of decks with several materials, and with several nodes at one place.

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

class ImportingSections : public Imports {};

/// Two cubes above one another; the upper stands on node 27, at the place of node 7, in place of it.
std::string column(const std::string& node) {
    return "*NODE, NSET=All\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
           "15,0,0,2\n16,1,0,2\n17,1,1,2\n18,0,1,2\n27,1,1,1\n*ELEMENT, TYPE=C3D8, ELSET=Low\n1,1,2,3,4,5,6,7,8\n"
           "*ELEMENT, TYPE=C3D8, ELSET=High\n2,5,6," +
           node +
           ",8,15,16,17,18\n*NSET, NSET=Floor, GENERATE\n1,4\n*BOUNDARY\nFloor,1,3\n"
           "*MATERIAL, NAME=Soft\n*ELASTIC\n1000.,.3\n*DENSITY\n2.\n*MATERIAL, NAME=Hard\n*ELASTIC\n4000.,.2\n"
           "*DENSITY\n3.\n*EXPANSION, ZERO=20.\n1.E-5\n*SOLID SECTION, ELSET=High, MATERIAL=Hard\n"
           "*SOLID SECTION, ELSET=Low, MATERIAL=Soft\n";
}

TEST_F(ImportingSections, SectionsOfAPieceAreSectionsOfItsBody) {
    const ImportedScene imported =
        import("*STEP\n*STATIC\n*CLOAD\n17,3,1.\n*TEMPERATURE\nAll,120.\n*END STEP\n", DeckUnits::si, column("7"));
    EXPECT_THAT(imported.lost, IsEmpty());
    const scene::Scene scene = checked(imported);
    ASSERT_EQ(scene.bodies.size(), 1u);
    ASSERT_EQ(scene.bodies[0].second.sections.size(), 1u);
    const app::Plan plan = plan_of(scene);
    const model::Body& body = plan.model.bodies[0];
    ASSERT_EQ(body.mesh.blocks.size(), 2u);
    const bool low_first = body.mesh.blocks[0].connectivity.front() == 0; // node 1
    EXPECT_THAT(body.density, ElementsAre(low_first ? 2 : 3, low_first ? 3 : 2));
    EXPECT_THAT(body.expansion, ElementsAre(low_first ? 0 : 1e-5, low_first ? 1e-5 : 0));
    EXPECT_NE(body.kernels[0]->linear(), body.kernels[1]->linear()); // what grows remembers temperatures
}

TEST_F(ImportingSections, GravityOnSeveralDensitiesIsLost) {
    EXPECT_THAT(import("*STEP\n*STATIC\n*DLOAD\nLow,GRAV,10.,0,0,-1\nHigh,GRAV,10.,0,0,-1\n*END STEP\n", DeckUnits::si,
                       column("7"))
                    .lost,
                Contains(HasSubstr("its materials differ in density")));
}

TEST_F(ImportingSections, NodesAtOnePlaceAreToldApartByTheirNumbers) {
    for (const auto& [node, place] : {std::pair{7, 6}, {27, 12}}) {
        const ImportedScene imported = import("*STEP\n*STATIC\n*CLOAD\n" + std::to_string(node) + ",1,5.\n*END STEP\n",
                                              DeckUnits::si, column("27"));
        EXPECT_THAT(imported.lost, IsEmpty());
        EXPECT_THAT(imported.text, AllOf(HasSubstr("keep_non_manifold"), HasSubstr("node_numbers: ")));
        const app::Plan plan = plan_of(checked(imported));
        const Field force = plan.stages.at(0).force(plan.model.X.size(), 1);
        for (std::size_t i = 0; i < force.size(); ++i)
            EXPECT_EQ(force[i], i == static_cast<std::size_t>(place) ? Vec3(5, 0, 0) : Vec3(0, 0, 0))
                << node << " " << i;
    }
}

} // namespace
} // namespace osculate::deck::OSCULATE_THIS_FILE
