/// Decks as Abaqus/CAE writes them: parts, instances, an assembly.

#include "deck/imported.hpp"
#include "osculate/mesh/mesh_error.hpp"
#include "support/diary.hpp"

#include <gmock/gmock.h>

namespace osculate::deck::OSCULATE_THIS_FILE {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

class ImportingParts : public Imports {};

const std::string steel = "*Material, name=Steel\n*Elastic\n210000., 0.3\n*Density\n7.8e-09,\n";
const std::string interaction = "*Surface Interaction, name=IntProp-1\n1.,\n*Friction, slip tolerance=0.005\n 0.25,\n"
                                "*Surface Behavior, pressure-overclosure=HARD\n";

/// A small cube on a large one; the small one is turned by 90 degrees about its own axis.
const std::string flat =
    "*Node\n1,0,0,0\n2,40,0,0\n3,40,40,0\n4,0,40,0\n5,0,0,40\n6,40,0,40\n7,40,40,40\n8,0,40,40\n"
    "11,30,10,40\n12,30,30,40\n13,10,30,40\n14,10,10,40\n15,30,10,60\n16,30,30,60\n17,10,30,60\n18,10,10,60\n"
    "*Element, type=C3D8, elset=Large\n1,1,2,3,4,5,6,7,8\n*Element, type=C3D8, elset=Small\n2,11,12,13,14,15,16,17,18\n"
    "*Nset, nset=Floor\n1,2,3,4\n*Nset, nset=Lid\n15,16,17,18\n*Nset, nset=Corner\n15\n"
    "*Surface, name=Under\nSmall,S1\n*Surface, name=Over\nLarge,S2\n*Surface, name=Side\nSmall,S3\n"
    "*Solid Section, elset=Large, material=Steel\n*Solid Section, elset=Small, material=Steel\n" +
    steel + interaction +
    "*Contact Pair, interaction=IntProp-1, type=SURFACE TO SURFACE\nUnder, Over\n*Boundary\nFloor, ENCASTRE\n"
    "*Step\n*Static\n0.5, 1.\n*Boundary\nLid, 3, 3, -0.02\n15, 1, 1\n16, 1, 2\n17, 2, 2\n*Dsload\nSide, P, 3.\n"
    "*Cload\nCorner, 2, 7.\n*End Step\n";

const std::string parts =
    "*Heading\n** Job name: press. Model: Model-1\n*Preprint, echo=NO, model=NO, history=NO, contact=NO\n**\n** "
    "PARTS\n**\n"
    "*Part, name=Large\n*Node\n      1,           0.,           0.,           0.\n2,40.,0,0\n3,40,40,0\n4,0,40,0\n"
    "5,0,0,40\n6,40,0,40\n7,40,40,40\n8,0,40,40\n*Element, type=C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n"
    "*Nset, nset=Set-1, generate\n 1,  8,  1\n*Elset, elset=Set-1\n 1,\n*Nset, nset=Floor\n 1, 2, 3, 4\n"
    "** Section: Section-1\n*Solid Section, elset=Set-1, material=Steel\n,\n*End Part\n**\n"
    "*Part, name=Small\n*Node\n1,0,0,0\n2,20,0,0\n3,20,20,0\n4,0,20,0\n5,0,0,20\n6,20,0,20\n7,20,20,20\n8,0,20,20\n"
    "*Element, type=C3D8\n1, 1, 2, 3, 4, 5, 6, 7, 8\n*Elset, elset=Set-1\n 1,\n"
    "*Elset, elset=_Under_S1, internal\n 1,\n*Surface, type=ELEMENT, name=Under\n_Under_S1, S1\n"
    "*Solid Section, elset=Set-1, material=Steel\n,\n*End Part\n**\n** ASSEMBLY\n**\n*Assembly, name=Assembly\n**\n"
    "*Instance, name=Large-1, part=Large\n*End Instance\n**\n*Instance, name=Small-1, part=Small\n"
    "         10.,          10.,          40.\n"
    "         20.,          20.,          40.,          20.,          20.,          41.,          90.\n*End "
    "Instance\n**\n"
    "*Nset, nset=_PickedSet5, internal, instance=Small-1, generate\n 5,  8,  1\n"
    "*Nset, nset=\"The corner\", instance=Small-1\n 5,\n"
    "*Elset, elset=_Over_S2, internal, instance=Large-1\n 1,\n*Surface, type=ELEMENT, name=Over\n_Over_S2, S2\n"
    "*Surface, type=ELEMENT, name=_PickedSurf7, internal\nSmall-1.Set-1, S3\n*End Assembly\n" +
    steel + interaction +
    "** Interaction: Int-1\n*Contact Pair, interaction=IntProp-1, type=SURFACE TO SURFACE\nSmall-1.Under, Over\n"
    "** BOUNDARY CONDITIONS\n*Boundary\nLARGE-1.FLOOR, ENCASTRE\n"
    "*Step, name=Step-1, nlgeom=NO\n*Static\n0.5, 1., 1e-05, 1.\n*Boundary\n_PickedSet5, 3, 3, -0.02\n"
    "Small-1.5, 1, 1\nsmall-1.6, 1, 2\nAssembly.Small-1.7, 2, 2\n*Dsload\n_PickedSurf7, P, 3.\n"
    "*Cload\n\"The corner\", 2, 7.\n**\n** OUTPUT REQUESTS\n*Restart, write, frequency=0\n"
    "*Output, field, variable=PRESELECT\n*Output, history, variable=PRESELECT\n*End Step\n";

TEST_F(ImportingParts, RunsAsTheSameModelWrittenFlat) {
    const auto run = [&](const std::string& deck) {
        const ImportedScene imported = import("", DeckUnits::mm, deck);
        EXPECT_THAT(imported.lost, IsEmpty());
        app::Plan plan = support::compiled(checked(imported));
        return support::diary_of(plan);
    };
    const support::Diary a = run(flat), b = run(parts);
    ASSERT_EQ(a.states.size(), b.states.size());
    ASSERT_THAT(a.states, SizeIs(2));
    for (std::size_t k = 0; k < a.states.size(); ++k) {
        ASSERT_EQ(a.states[k].u.size(), b.states[k].u.size());
        double largest = 0, difference = 0;
        for (std::size_t n = 0; n < a.states[k].u.size(); ++n) {
            largest = std::max(largest, a.states[k].u[n].norm());
            difference = std::max(difference, (a.states[k].u[n] - b.states[k].u[n]).norm());
        }
        EXPECT_GT(largest, 9e-6);
        EXPECT_LT(difference, 1e-9 * largest);
        ASSERT_THAT(a.states[k].contact, SizeIs(1));
        Vec3 force = Vec3::Zero(), other = Vec3::Zero();
        for (const Vec3& f : a.states[k].contact[0].lambda) force += f;
        for (const Vec3& f : b.states[k].contact[0].lambda) other += f;
        EXPECT_LT((force - other).norm(), 1e-9 * force.norm());
        EXPECT_GT(force.norm(), 1000);
    }
}

TEST_F(ImportingParts, TheAssemblyTiesSurfacesOfItsInstances) {
    std::string deck = parts;
    deck.insert(deck.find("*End Assembly"),
                "** Constraint: Constraint-1\n*Tie, name=Constraint-1, adjust=yes\nSmall-1.Under, Over\n");
    const ImportedScene imported = import("", DeckUnits::mm, deck);
    EXPECT_THAT(imported.lost, IsEmpty());
    ASSERT_THAT(checked(imported).ties, SizeIs(1));
    EXPECT_EQ(checked(imported).ties[0].second.master, "Over");
}

TEST_F(ImportingParts, EquationsNameNodesOfInstances) {
    std::string deck = parts;
    deck.insert(deck.find("*End Assembly"), "*Equation\n2\nSmall-1.6, 1, 1.\nLarge-1.7, 1, -1.\n");
    const ImportedScene imported = import("", DeckUnits::mm, deck);
    EXPECT_THAT(imported.lost, IsEmpty());
    EXPECT_THAT(scene::parse_scene(imported.text, "imported.yaml").equations, SizeIs(1));
}

TEST_F(ImportingParts, BodiesAreNamedAfterInstances) {
    const scene::Scene scene = checked(import("", DeckUnits::mm, parts));
    ASSERT_EQ(scene.bodies.size(), 2u);
    EXPECT_EQ(scene.bodies[0].first, "Large-1");
    EXPECT_EQ(scene.bodies[1].first, "Small-1");
}

TEST_F(ImportingParts, ScenesMayUseTheSetsOfInstances) {
    std::ofstream(path) << parts;
    const scene::Scene scene = scene::parse_scene(
        "bodies:\n  small:\n    mesh: {file: {path: " + path.string() +
            ", part: Small-1}, scale: 0.001}\n    material: {linear_elastic: {E: 1 MPa, nu: 0.3}}\n"
            "sets:\n  under: {body: small, surface: Small-1.Under}\n  lid: {body: small, nodes: _PickedSet5}\n"
            "supports:\n  under: {fix: [x, y, z]}\nstages:\n  s: {steps: 1, nodal_force: {lid: [0 N, 0 N, -1 N]}}\n",
        "scene.yaml");
    const app::Plan plan = plan_of(scene);
    Vec3 sum = Vec3::Zero();
    for (const Vec3& f : plan.stages.at(0).force(plan.model.X.size(), 1)) sum += f;
    EXPECT_DOUBLE_EQ(sum[2], -4);
}

/// Numbers of the nodes that Abaqus would not find, and those of no instance.
TEST_F(ImportingParts, WhatNoInstanceHasIsLostOrRefused) {
    const auto with_boundary = [&](const std::string& line) {
        std::string deck = parts;
        deck.replace(deck.find("LARGE-1.FLOOR"), std::string("LARGE-1.FLOOR").size(), line);
        return deck;
    };
    for (const char* line : {"Floor", "5", "Large-1.Lid"}) {
        const ImportedScene imported = import("", DeckUnits::mm, with_boundary(line));
        EXPECT_THAT(imported.lost, Contains(AllOf(HasSubstr(std::string(line) + ", ENCASTRE"),
                                                  HasSubstr("no node or node set of that name"))))
            << line;
    }
    EXPECT_THROW(import("", DeckUnits::mm, with_boundary("Large-2.Floor")), mesh::MeshError);
    EXPECT_THROW(import("", DeckUnits::mm, with_boundary("Large-1.77")), mesh::MeshError);
}

TEST_F(ImportingParts, ReferencePointsOfTheAssemblyAreNodesOfNoElement) {
    std::string deck = parts;
    deck.insert(deck.find("*Nset, nset=_PickedSet5"), "*Node\n1, 20., 20., 80.\n*Nset, nset=RP\n1\n");
    deck.insert(deck.find("*Dsload"), "RP, 1, 1, 0.5\n");
    const ImportedScene imported = import("", DeckUnits::mm, deck);
    EXPECT_THAT(imported.lost, Contains(HasSubstr("*BOUNDARY on 1 nodes: no element has them")));
    (void)checked(imported);
}

/// Axes of the section of one cube that is turned by 90 degrees about z.
Mat3 axes_of(const scene::Scene& scene, std::size_t section) {
    const auto& body = scene.bodies.at(0).second;
    const auto& material = section == 0 ? body.material : body.sections.at(section - 1).second.material;
    return std::get<scene::Orthotropic>(material).axes;
}

TEST_F(ImportingParts, SectionsAndAxesTurnWithTheirInstance) {
    const std::string ortho = "*Elastic, type=ENGINEERING CONSTANTS\n100.,200.,300.,.1,.1,.1,40.,50.,\n60.,\n";
    const auto deck = [&](const std::string& orientation) {
        return "*Part, name=P\n*Node\n1,0,0,0\n2,1,0,0\n3,1,1,0\n4,0,1,0\n5,0,0,1\n6,1,0,1\n7,1,1,1\n8,0,1,1\n"
               "9,0,0,2\n10,1,0,2\n11,1,1,2\n12,0,1,2\n*Nset, nset=Floor\n1,2,3,4\n"
               "*Element, type=C3D8\n1,1,2,3,4,5,6,7,8\n2,5,6,7,8,9,10,11,12\n*Elset, elset=Low\n1\n*Elset, "
               "elset=High\n2\n"
               "*Orientation, name=Ori-1\n1., 0., 0., 0., 1., 0.\n3, 0.\n*Orientation, name=Ori-2\n" +
               orientation +
               "*Solid Section, elset=Low, orientation=Ori-1, material=Soft\n,\n"
               "*Solid Section, elset=High, orientation=Ori-2, material=Hard\n,\n*End Part\n*Assembly, name=Assembly\n"
               "*Instance, name=P-1, part=P\n5., 0., 0.\n0., 0., 0., 0., 0., 1., 90.\n*End Instance\n*End Assembly\n"
               "*Material, name=Soft\n" +
               ortho + "*Material, name=Hard\n" + ortho +
               "*Boundary\nP-1.Floor, 1, 3\n*Step\n*Static\n*Cload\nP-1.12, 3, 1.\n*End Step\n";
    };
    const auto expect = [](const Vec3& axis, const Vec3& along) {
        EXPECT_NEAR(axis.normalized().dot(along.normalized()), 1, 1e-9);
    };
    // through (1, 0, 1), (0, 0, 0) and the origin (0, 0, 1): x and -z of the part
    const ImportedScene imported = import("", DeckUnits::si, deck("1., 0., 1., 0., 0., 0., 0., 0., 1.\n"));
    EXPECT_THAT(imported.lost, IsEmpty());
    const scene::Scene scene = checked(imported);
    ASSERT_THAT(scene.bodies.at(0).second.sections, SizeIs(1));
    const bool low_first = std::abs(axes_of(scene, 0)(2, 1)) < 0.5;
    const auto low = axes_of(scene, low_first ? 0 : 1), high = axes_of(scene, low_first ? 1 : 0);
    expect(low.col(0), Vec3(0, 1, 0));
    expect(low.col(1), Vec3(-1, 0, 0));
    expect(high.col(0), Vec3(0, 1, 0));
    expect(high.col(1), Vec3(0, 0, -1));
    // a further 90 degrees about the third axis
    const scene::Scene turned = checked(import("", DeckUnits::si, deck("1., 0., 0., 0., 1., 0.\n3, 90.\n")));
    const auto first = axes_of(turned, 0), second = axes_of(turned, 1);
    const bool as_given = std::abs(first(1, 0)) > 0.5;
    expect((as_given ? second : first).col(0), Vec3(-1, 0, 0));
    EXPECT_THAT(
        import("", DeckUnits::si,
               deck("3, 7, 8\n").replace(deck("3, 7, 8\n").find("name=Ori-2"), 10, "name=Ori-2, definition=NODES"))
            .lost,
        Contains(HasSubstr("only axes through points")));
}

} // namespace
} // namespace osculate::deck::OSCULATE_THIS_FILE
