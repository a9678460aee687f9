/// General contact of decks.

#include "deck/imported.hpp"

#include <gmock/gmock.h>

namespace osculate::deck::OSCULATE_THIS_FILE {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Two cubes as in the other tests, each with a surface that is all of its outside, but without pairs.
const std::string model = mesh_of_cubes +
                          "*ELSET, ELSET=Large\n1\n*ELSET, ELSET=Small\n2\n*SURFACE, NAME=Outside of large\nLarge\n"
                          "*SURFACE, NAME=Outside of small\nSmall,\n"
                          "*MATERIAL, NAME=Steel\n*ELASTIC\n210000.,.3\n*SOLID SECTION, ELSET=Large, MATERIAL=Steel\n"
                          "*SOLID SECTION, ELSET=Small, MATERIAL=Steel\n"
                          "*SURFACE INTERACTION, NAME=IntProp-1\n1.,\n*FRICTION, SLIP TOLERANCE=0.005\n .25,\n"
                          "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=HARD\n"
                          "*SURFACE INTERACTION, NAME=IntProp-2\n1.,\n*FRICTION\n .5,\n"
                          "*SURFACE INTERACTION, NAME=Soft\n*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1E7\n"
                          "*BOUNDARY\nFloor,1,3\nLid,1,2\n";
const std::string step = "*STEP\n*STATIC, DIRECT\n.25,1.\n*DSLOAD\nTop,P,5.\n*END STEP\n";

class ImportingGeneralContact : public Imports {
protected:
    ImportedScene with(const std::string& contact, const std::string& steps = step) const {
        return import(contact + steps, DeckUnits::mm, model);
    }
};

TEST_F(ImportingGeneralContact, AllSurfacesMeetWithTheLawOfAll) {
    const ImportedScene imported = with("*Contact\n*Contact Inclusions, ALL EXTERIOR\n*Contact Property Assignment\n"
                                        " ,  , IntProp-1\n");
    EXPECT_THAT(imported.lost, IsEmpty());
    const scene::Scene scene = checked(imported);
    ASSERT_TRUE(scene.general);
    EXPECT_EQ(scene.general->friction, 0.25);
    EXPECT_THAT(scene.general->pairs, IsEmpty());
    EXPECT_THAT(scene.contact, IsEmpty());
    const scene::Scene smooth = checked(with("*CONTACT\n*CONTACT INCLUSIONS\n,\n")); // no law: no friction
    ASSERT_TRUE(smooth.general);
    EXPECT_EQ(smooth.general->friction, 0);
    EXPECT_FALSE(scene::parse_scene(with("").text, "imported.yaml").general);
}

TEST_F(ImportingGeneralContact, MayBeginInTheFirstStepButNotLater) {
    const std::string contact = "*Contact, op=NEW\n*Contact Inclusions, ALL EXTERIOR\n";
    std::string first = step, second = step;
    first.insert(first.find("*DSLOAD"), contact);
    EXPECT_THAT(with("", first).lost, IsEmpty());
    EXPECT_TRUE(checked(with("", first)).general);
    const ImportedScene later = with("", second + first);
    EXPECT_THAT(later.lost, Contains(HasSubstr("contact of all surfaces is for the whole run")));
    EXPECT_FALSE(scene::parse_scene(later.text, "imported.yaml").general);
}

TEST_F(ImportingGeneralContact, WholeBodiesMayBeLeftOutOrHaveALawOfTheirOwn) {
    const std::string all = "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n*CONTACT PROPERTY ASSIGNMENT\n,,IntProp-1\n";
    const ImportedScene law = with(all + "outside of large, Outside of small, INTPROP-2\n");
    EXPECT_THAT(law.lost, IsEmpty());
    const scene::Scene with_law = checked(law);
    ASSERT_THAT(with_law.general->pairs, SizeIs(1));
    const scene::GeneralRule& rule = with_law.general->pairs[0].second;
    EXPECT_EQ(rule.between, (std::array<std::string, 2>{"Large", "Small"}));
    EXPECT_EQ(rule.friction, 0.5);
    const ImportedScene out = with(all + "*CONTACT EXCLUSIONS\nOutside of large, Outside of small\n");
    EXPECT_THAT(out.lost, IsEmpty());
    EXPECT_FALSE(checked(out).general->pairs.at(0).second.contact);
    // a body with itself
    const scene::Scene itself = checked(with(all + "*CONTACT EXCLUSIONS\nOutside of large\n"));
    EXPECT_EQ(itself.general->pairs.at(0).second.between, (std::array<std::string, 2>{"Large", "Large"}));
    // the last one counts, also where it says what holds for all
    const scene::Scene again = checked(
        with(all + "Outside of large, Outside of small, IntProp-2\nOutside of small, Outside of large, IntProp-1\n"));
    EXPECT_EQ(again.general->pairs.back().second.friction, 0.25);
}

TEST_F(ImportingGeneralContact, PartsOfSurfacesAreNotToldApart) {
    const std::string all = "*CONTACT\n*CONTACT INCLUSIONS, ALL EXTERIOR\n*CONTACT PROPERTY ASSIGNMENT\n,,IntProp-1\n";
    EXPECT_THAT(with(all + "Over, Under, IntProp-2\n").lost, Contains(HasSubstr("the law of OVER and UNDER")));
    EXPECT_THAT(with(all + "Over, Under, IntProp-1\n").lost, IsEmpty()) << "the same as of all";
    EXPECT_THAT(
        with(all + "*CONTACT EXCLUSIONS\nOver, Outside of small\n").lost,
        Contains(AllOf(HasSubstr("*CONTACT EXCLUSIONS of OVER and OUTSIDE OF SMALL"), HasSubstr("whole bodies"))));
    EXPECT_THAT(with(all + "*CONTACT EXCLUSIONS\n,\n").lost, Contains(HasSubstr("all surfaces and all")));
}

TEST_F(ImportingGeneralContact, NamedSurfacesBecomePairs) {
    const ImportedScene imported = with("*CONTACT\n*CONTACT INCLUSIONS\nOver, Under\n*CONTACT PROPERTY ASSIGNMENT\n"
                                        ",,IntProp-1\nUnder, Over, IntProp-2\n");
    EXPECT_THAT(imported.lost, IsEmpty());
    const scene::Scene scene = checked(imported);
    EXPECT_FALSE(scene.general);
    ASSERT_THAT(scene.contact, SizeIs(1));
    EXPECT_EQ(scene.contact[0].second.friction, 0.5);
    EXPECT_EQ(scene.contact[0].second.between, (std::array<std::string, 2>{"Over", "Under"}));
    EXPECT_EQ(scene.contact[0].second.discretisation, std::nullopt);
    const scene::Scene soft =
        checked(with("*CONTACT\n*CONTACT INCLUSIONS\nOver, Under\n*CONTACT PROPERTY ASSIGNMENT\n,,Soft\n"));
    EXPECT_TRUE(std::holds_alternative<scene::LinearOverclosure>(soft.contact.at(0).second.pressure_overclosure));
}

TEST_F(ImportingGeneralContact, WhatHasNoCounterpartIsLost) {
    const auto lost = [&](const std::string& cards) { return with("*CONTACT\n" + cards).lost; };
    const std::string all = "*CONTACT INCLUSIONS, ALL EXTERIOR\n";
    EXPECT_THAT(lost("*CONTACT INCLUSIONS\nOver,\n"), Contains(HasSubstr("contact of OVER and itself")));
    EXPECT_THAT(lost("*CONTACT INCLUSIONS\n, Over\n"), Contains(HasSubstr("contact of all surfaces and OVER")));
    EXPECT_THAT(lost("*CONTACT INCLUSIONS\nOver, Nowhere\n"),
                AllOf(Contains(AllOf(HasSubstr(".inp:"), HasSubstr("no surface is called 'NOWHERE'"))),
                      Contains(HasSubstr("no *CONTACT INCLUSIONS says which surfaces meet"))));
    EXPECT_THAT(lost(""), Contains(HasSubstr("no *CONTACT INCLUSIONS says which surfaces meet")));
    EXPECT_THAT(lost(all + "*CONTACT PROPERTY ASSIGNMENT\n,,None\n"),
                Contains(HasSubstr("no *SURFACE INTERACTION is called 'NONE'")));
    EXPECT_THAT(lost(all + "*CONTACT INITIALIZATION ASSIGNMENT\n,,Init-1\n"),
                Contains(HasSubstr("*CONTACT INITIALIZATION ASSIGNMENT")));
    EXPECT_THAT(lost("*CONTACT INCLUSIONS\nOver, Under\n*CONTACT EXCLUSIONS\nTop, Over\n"),
                Contains(HasSubstr("*CONTACT EXCLUSIONS of TOP and OVER")));
    EXPECT_THAT(lost("*CONTACT INCLUSIONS\nOver, Under\n*CONTACT PROPERTY ASSIGNMENT\nTop, Over, IntProp-2\n"),
                Contains(HasSubstr("no *CONTACT INCLUSIONS has just these surfaces")));
    const ImportedScene soft = with("*CONTACT\n" + all + "*CONTACT PROPERTY ASSIGNMENT\n,,Soft\n");
    EXPECT_THAT(soft.lost, IsEmpty());
    EXPECT_THAT(soft.notes, Contains(HasSubstr("overclosure and stick slope of SOFT")));
}

} // namespace
} // namespace osculate::deck::OSCULATE_THIS_FILE
