/// Laws of interfaces in decks.

#include "deck/imported.hpp"

#include <gmock/gmock.h>

namespace osculate::deck::OSCULATE_THIS_FILE {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;

class ImportingLaws : public Imports {};

TEST_F(ImportingLaws, LinearOverclosureAndStickSlopeAreThoseOfTheDeck) {
    const scene::Scene scene = checked(import(pressed));
    const scene::Pair& pair = scene.contact.at(0).second;
    ASSERT_TRUE(std::holds_alternative<scene::LinearOverclosure>(pair.pressure_overclosure));
    EXPECT_DOUBLE_EQ(std::get<scene::LinearOverclosure>(pair.pressure_overclosure).stiffness, 1e7 * 1e9) << "N/mm^3";
    ASSERT_TRUE(pair.stick_stiffness);
}

TEST_F(ImportingLaws, OtherLawsOfOverclosureAreThoseOfTheDeckToo) {
    const auto law_of = [&](const std::string& cards) {
        return checked(import("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=" + cards + pressed)).contact.at(0).second;
    };
    EXPECT_EQ(law_of("EXPONENTIAL\n.01,2.\n").pressure_overclosure,
              scene::PressureOverclosure(scene::ExponentialOverclosure{2e6, 0.01e-3}));
    const scene::Pair table = law_of("TABULAR\n0.,-.5\n1.,0.\n4.,.5\n");
    ASSERT_TRUE(std::holds_alternative<scene::TabularOverclosure>(table.pressure_overclosure));
    const auto& rows = std::get<scene::TabularOverclosure>(table.pressure_overclosure).table.rows;
    EXPECT_EQ(rows, (std::vector<std::array<double, 2>>{{-0.5e-3, 0}, {0, 1e6}, {0.5e-3, 4e6}}));
    for (const char* bad : {"TABULAR\n1.,0.\n4.,.5\n", "TABULAR\n0.,0.\n4.,-.5\n", "TABULAR\n0.,0.\n",
                            "EXPONENTIAL\n.01\n", "LINEAR\n-1.\n"})
        EXPECT_EQ(import(std::string("*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=") + bad + pressed).lost.size(), 1u)
            << bad;
}

TEST_F(ImportingLaws, StepsChangeTheLawOfOverclosure) {
    const std::string change = "*STEP\n*STATIC\n*CHANGE SURFACE BEHAVIOR, INTERACTION=I\n"
                               "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=EXPONENTIAL\n.01,2.\n*END STEP\n";
    const scene::Scene scene = checked(import(pressed + change));
    ASSERT_EQ(scene.stages.size(), 2u);
    ASSERT_EQ(scene.stages[1].second.pressure_overclosure.size(), 1u);
    EXPECT_EQ(scene.stages[1].second.pressure_overclosure[0].first, scene.contact.at(0).first);
    EXPECT_THAT(import(pressed + "*STEP\n*STATIC\n*CHANGE SURFACE BEHAVIOR, INTERACTION=None\n"
                                 "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR\n1.\n*END STEP\n")
                    .lost,
                ElementsAre(HasSubstr("no *SURFACE INTERACTION is called NONE")));
}

TEST_F(ImportingLaws, FrictionOfRestIsThatOfTheDeck) {
    const scene::Pair pair = checked(import("*FRICTION, EXPONENTIAL DECAY\n.4,.3,2.\n" + pressed)).contact.at(0).second;
    EXPECT_EQ(pair.friction, 0.3);
    EXPECT_EQ(pair.static_friction, 0.4);
    for (const char* bad : {".3,.4", ".3", ".4,0."})
        EXPECT_EQ(import(std::string("*FRICTION, EXPONENTIAL DECAY\n") + bad + "\n" + pressed).lost.size(), 1u) << bad;
    EXPECT_EQ(import("*FRICTION, EXPONENTIAL DECAY\n.4,.3,2.\n" + pressed +
                     "*STEP\n*STATIC\n*CHANGE FRICTION, INTERACTION=I\n*FRICTION\n.2\n*END STEP\n")
                  .lost.size(),
              1u);
}

TEST_F(ImportingLaws, DampingOfContactActsInDynamics) {
    const std::string damped = "*CONTACT DAMPING\n3.\n",
                      dynamic = "*STEP\n*DYNAMIC\n.1,1.\n*DSLOAD\nTop,P,5.\n*END STEP\n";
    EXPECT_EQ(checked(import(damped + pressed)).contact.at(0).second.damping, 0);
    EXPECT_THAT(import(damped + dynamic).text, HasSubstr("damping: 3000000000"));
    const std::string both = import("*CONTACT DAMPING, TANGENT FRACTION=.5\n3.\n" + dynamic).text;
    EXPECT_THAT(both, HasSubstr("\n    damping: 3000000000\n    tangential_damping: 1500000000\n"));
    EXPECT_EQ(import("*CONTACT DAMPING, TANGENT FRACTION=-.5\n3.\n" + pressed).lost.size(), 1u);
}

} // namespace
} // namespace osculate::deck::OSCULATE_THIS_FILE
