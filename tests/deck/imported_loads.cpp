/// Loads of decks, by the forces that they come to.

#include "deck/imported.hpp"

#include <gmock/gmock.h>

namespace osculate::deck::OSCULATE_THIS_FILE {
namespace {

using ::testing::AllOf;
using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// Three cubes of 1 mm in a row, each with its surface on top.
const std::string row =
    "*NODE\n1,0,0,0\n2,1,0,0\n3,2,0,0\n4,3,0,0\n5,0,1,0\n6,1,1,0\n7,2,1,0\n8,3,1,0\n"
    "11,0,0,1\n12,1,0,1\n13,2,0,1\n14,3,0,1\n15,0,1,1\n16,1,1,1\n17,2,1,1\n18,3,1,1\n"
    "*ELEMENT, TYPE=C3D8, ELSET=Row\n1,1,2,6,5,11,12,16,15\n2,2,3,7,6,12,13,17,16\n3,3,4,8,7,13,14,18,17\n"
    "*ELSET, ELSET=Left\n1\n*ELSET, ELSET=Right\n2,3\n"
    "*NSET, NSET=Floor, GENERATE\n1,8\n*NSET, NSET=Tops, GENERATE\n11,18\n"
    "*SURFACE, NAME=Top\nRow,S2\n*SURFACE, NAME=Middle\n2,S2\n"
    "*MATERIAL, NAME=M\n*ELASTIC\n210000.,.3\n*DENSITY\n7.8E-9\n*SOLID SECTION, ELSET=Row, MATERIAL=M\n"
    "*AMPLITUDE, NAME=Up\n0,0,1,1\n*BOUNDARY\nFloor,1,3\n";
constexpr double round_off = 1e-9; // of forces of some newtons

class ImportedLoads : public Imports {
protected:
    ImportedScene imported;

    app::Plan plan(const std::string& steps) {
        imported = import(steps, DeckUnits::mm, row);
        return plan_of(scene::parse_scene(imported.text, "imported.yaml"));
    }
    static Vec3 at_end(const app::Plan& plan, std::size_t stage, double from_x = -1, double to_x = 4) {
        Vec3 sum = Vec3::Zero();
        const Field force = plan.stages.at(stage).force(plan.model.X.size(), 1);
        for (std::size_t n = 0; n < plan.model.X.size(); ++n)
            if (plan.model.X[n].x() > 1e-3 * from_x && plan.model.X[n].x() < 1e-3 * to_x) sum += force[n];
        return sum;
    }
    /// Force of all loads at a time of a stage, courses included.
    static Vec3 at_time(const app::Plan& plan, std::size_t number, double t) {
        const time::Stage& stage = plan.stages.at(number);
        const double ramp = stage.ramp ? t / stage.duration : 1;
        Field force = stage.force(plan.model.X.size(), ramp);
        for (const time::CourseForce& part : stage.course_forces)
            part.pattern.add_to(stage.courses[static_cast<std::size_t>(part.course)].at(t), force);
        Vec3 sum = Vec3::Zero();
        for (const Vec3& f : force) sum += f;
        return sum;
    }
};

std::string step(const std::string& loads, const std::string& parameters = "") {
    return "*STEP" + parameters + "\n*STATIC\n1.,1.\n" + loads + "*END STEP\n";
}

TEST_F(ImportedLoads, AddOnAFaceThatAStepLoadsTwice) {
    EXPECT_NEAR(at_end(plan(step("*DSLOAD\nTop,P,5.\nTop,P,5.\n")), 0).z(), -30, round_off) << "10 MPa on 3 mm^2";
    EXPECT_THAT(imported.notes, ElementsAre(AllOf(HasSubstr(".inp:49: pressure on 3 faces"), HasSubstr("they add"))));
    EXPECT_NEAR(at_end(plan(step("*DSLOAD\nTop,P,5.\n*DSLOAD\nMiddle,P,2.\n")), 0).z(), -17, round_off);
    EXPECT_NEAR(at_end(plan(step("*DSLOAD\nTop,P,5.\n*DLOAD\n2,P2,3.\nRow,P2,1.\n")), 0).z(), -21, round_off);
    EXPECT_NEAR(at_end(plan(step("*DSLOAD\nTop,P,5.\n*CLOAD\n12,3,-.25\n13,3,-.25\n16,3,-.25\n17,3,-.25\n")), 0).z(),
                -16, round_off);
    EXPECT_THAT(imported.lost, IsEmpty());
}

TEST_F(ImportedLoads, ChangeOnTheFacesAlone) {
    const app::Plan changed = plan(step("*DSLOAD\nTop,P,5.\n") + step("*DSLOAD\nMiddle,P,2.\n"));
    EXPECT_NEAR(at_end(changed, 0).z(), -15, round_off);
    EXPECT_NEAR(at_end(changed, 1).z(), -12, round_off);
    EXPECT_NEAR(at_end(changed, 1, -1, .5).z(), -2.5, round_off) << "the left edge's share of 5 N";
    EXPECT_NEAR(at_end(changed, 1, .5, 1.5).z(), -2.5 - 1, round_off) << "shares of 5 N and of 2 N";
    EXPECT_NEAR(at_time(changed, 1, .5).z(), -13.5, round_off) << "linearly";
    EXPECT_THAT(imported.lost, IsEmpty());
}

TEST_F(ImportedLoads, OfAnotherStepAreForgottenWhereItSaysSo) {
    const std::string first = step("*DSLOAD\nTop,P,5.\n");
    EXPECT_NEAR(at_end(plan(first + step("*DSLOAD, OP=NEW\nMiddle,P,2.\n")), 1).z(), -2, round_off);
    EXPECT_NEAR(at_end(plan(first + step("*DLOAD, OP=NEW\n2,P2,2.\n")), 1).z(), -17, round_off) << "another keyword's";
    EXPECT_THAT(imported.notes, Contains(HasSubstr("on 1 faces that an earlier step loads by the other")));
    EXPECT_NEAR(at_end(plan(first + step("")), 1).z(), -15, round_off) << "a step that gives none";
}

TEST_F(ImportedLoads, WithAndWithoutAnAmplitudeAddAtAllTimes) {
    const app::Plan both = plan(step("*DSLOAD\nTop,P,4.\n*DSLOAD, AMPLITUDE=Up\nMiddle,P,2.\n", ", AMPLITUDE=STEP"));
    EXPECT_NEAR(at_time(both, 0, 0).z(), -12, round_off);
    EXPECT_NEAR(at_time(both, 0, .25).z(), -12.5, round_off);
    const app::Plan later =
        plan(step("*DSLOAD, AMPLITUDE=Up\nTop,P,4.\n") + step("*DSLOAD\nTop,P,2.\n*DLOAD, AMPLITUDE=Up\n2,P2,8.\n"));
    EXPECT_NEAR(at_time(later, 1, 0).z(), -12, round_off);
    EXPECT_NEAR(at_time(later, 1, .5).z(), -9 - 4, round_off) << "3 MPa on three, 4 MPa on one";
    EXPECT_NEAR(at_time(later, 1, 1).z(), -6 - 8, round_off);
}

TEST_F(ImportedLoads, OnNodesAreReplacedNodeByNode) {
    const std::string all = "*CLOAD\n11,3,-1.\n14,3,-1.\n15,3,-1.\n18,3,-1.\n12,3,-2.\n13,3,-2.\n16,3,-2.\n17,3,-2.\n";
    EXPECT_NEAR(at_end(plan(step(all)), 0).z(), -12, round_off) << "4 MPa";
    EXPECT_NEAR(at_end(plan(step(all) + step("*CLOAD\nTops,3,0.\n")), 1).z(), 0, round_off);
    EXPECT_NEAR(at_end(plan(step(all) + step("*CLOAD, OP=NEW\n11,3,-1.\n12,3,-1.\n15,3,-1.\n16,3,-1.\n")), 1).z(), -4,
                round_off);
    const std::string left = "*CLOAD\n11,3,-1.\n12,3,-1.\n15,3,-1.\n16,3,-1.\n",
                      rest = "*CLOAD\n12,3,-2.\n13,3,-2.\n16,3,-2.\n17,3,-2.\n14,3,-1.\n18,3,-1.\n";
    EXPECT_NEAR(at_end(plan(step(left) + step(rest)), 1).z(), -12, round_off) << "nodes 11 and 15 keep theirs";
    EXPECT_NEAR(at_end(plan(step("*CLOAD\n11,3,0.\n")), 0).z(), 0, round_off);
    EXPECT_NEAR(at_end(plan(step(all) + step("*CLOAD\n11,3,-9.\n")), 1).z(), -20, round_off);
    const app::Plan along = plan(step("*CLOAD\n11,1,2.\n11,1,3.\n") + step("*CLOAD, AMPLITUDE=Up\n11,3,4.\n"));
    EXPECT_NEAR(at_end(along, 0).x(), 5, round_off) << "of one step they add";
    EXPECT_NEAR((at_time(along, 1, .5) - Vec3(5, 0, 2)).norm(), 0, round_off);
    EXPECT_THAT(imported.lost, IsEmpty());
}

TEST_F(ImportedLoads, OfSeveralGravitiesAddAsVectors) {
    constexpr double mass = 7.8e-9 * 3; // t
    const auto force = [&](const std::string& steps, std::size_t stage) { return at_end(plan(steps), stage); };
    constexpr double small = 1e-15; // of forces of 1e-7 N
    const Vec3 two = force(step("*DLOAD\nRow,GRAV,9.,0,0,-1\n*DLOAD\nRow,GRAV,4.,1,0,0\nRow,GRAV,1.,0,0,-1\n"), 0);
    EXPECT_NEAR((two - mass * Vec3(4, 0, -10)).norm(), 0, small);
    const Vec3 parts = force(step("*DLOAD\nLeft,GRAV,9.,0,0,-1\nRight,GRAV,9.,0,0,-1\n"), 0);
    EXPECT_NEAR((parts - mass * Vec3(0, 0, -9)).norm(), 0, small);
    EXPECT_THAT(imported.lost, IsEmpty());
    const Vec3 later = force(step("*DLOAD\nRow,GRAV,9.,0,0,-1\n") + step("*DLOAD\nRow,GRAV,4.,1,0,0\n"), 1);
    EXPECT_NEAR((later - mass * Vec3(4, 0, 0)).norm(), 0, small);
    EXPECT_THAT(imported.notes, Contains(HasSubstr("in another direction than in an earlier step")));
    (void)plan(step("*DLOAD\nLeft,GRAV,9.,0,0,-1\n"));
    EXPECT_THAT(imported.lost, SizeIs(1)) << "a third of a body";
}

TEST_F(ImportedLoads, ChangeAtOnceOrLinearlyAsTheStepSays) {
    const std::string dynamic = "\n*DYNAMIC\n.1,1.\n*END STEP\n";
    const auto ramp = [&](const std::string& steps) { return plan(steps).stages.at(0).ramp; };
    EXPECT_TRUE(ramp(step("")));
    EXPECT_FALSE(ramp(step("", ", AMPLITUDE=STEP")));
    EXPECT_FALSE(ramp("*STEP" + dynamic));
    EXPECT_TRUE(ramp("*STEP, AMPLITUDE=ramp" + dynamic));
    EXPECT_THAT(imported.lost, IsEmpty());
    (void)plan(step("", ", AMPLITUDE=Up"));
    EXPECT_THAT(imported.lost, SizeIs(1));
}

TEST_F(ImportedLoads, FollowTheirFacesInAllStepsWhereOneSaysSo) {
    const app::Plan both = plan(step("*DSLOAD\nTop,P,5.\n") + step("*DSLOAD\nTop,P,7.\n", ", NLGEOM"));
    ASSERT_THAT(both.stages.at(1).follower_pressures, SizeIs(1));
    EXPECT_DOUBLE_EQ(both.stages[1].follower_pressures[0].end, 7e6);
    EXPECT_NEAR(at_end(both, 1).z(), 0, round_off) << "not once more as a dead load";
}

} // namespace
} // namespace osculate::deck::OSCULATE_THIS_FILE
