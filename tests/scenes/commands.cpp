#include "scenes/program.hpp"

#include <gmock/gmock.h>
#include <regex>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::Not;

const std::string press = scene_file("tests/scenes/press.yaml");

class Command : public Program {};

TEST_F(Command, CheckReportsSizesPairsAndGaps) {
    const Outcome outcome = osculate({"check", press, "--set", "bodies.cap.mesh.block.origin=[0.3 m, 0.45 m, 1.02 m]",
                                      "--set", "contact.joint.discretisation=node"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    std::smatch line;
    ASSERT_TRUE(std::regex_search(outcome.out, line, std::regex("cut: (.*\n)"))) << outcome.out;
    const std::string estimated = line[1];
    EXPECT_EQ(
        outcome.out,
        "body base: 75 nodes, 32 elements\n"
        "body cap: 48 nodes, 18 elements\n"
        "degrees of freedom: 272\n" // 3 * 123, less 3 * 25 of the bed, 10 of the side, 12 of the rear
        "unknowns: 320, including contact forces\n"
        "estimate, mostly within a factor of 3 where no step is cut: " +
            estimated +
            "pair joint: 16 slave nodes, 16 master facets\n"
            "  16 slave nodes above the master, initial gap 0.02 m to 0.02 m\n"
            "  no overlap\n"
            "  advice: the meshes do not match: discretisation: petrov_galerkin would even out the pressures at single "
            "nodes\n"
            "stage press: 1 step(s) in 1 s\n"
            "stage pull: 3 step(s) in 3 s\n"
            "free: cap slides along y; friction alone can hold that\n");
    EXPECT_FALSE(std::filesystem::exists(folder / "out"));
}

TEST_F(Command, SaysWhatMistypedWordsWereMeantToBe) {
    for (const auto& [words, said] :
         {std::pair<std::vector<std::string>, std::string>{{"rnu", press},
                                                           "there is no command 'rnu'; did you mean 'run'?\n"},
          {{"frobnicate"}, "there is no command 'frobnicate'; `osculate --help` lists them\n"},
          {{"run", press, "--thred", "2"}, "there is no option '--thred'; did you mean '--threads'?\n"}}) {
        const Outcome outcome = osculate(words);
        EXPECT_EQ(outcome.code, 2);
        EXPECT_EQ(outcome.err, said);
    }
}

TEST_F(Command, SaysWhenNothingCanBeSaid) {
    const Outcome outcome = osculate({"keys"}, [] { ASSERT_NE(std::freopen("/dev/full", "w", stdout), nullptr); });
    EXPECT_EQ(outcome.code, 3);
    EXPECT_EQ(outcome.err, "what there was to say could not be written\n");
}

TEST_F(Command, AFolderThatIsGoneIsNoBug) {
    const Outcome outcome = osculate({"check", "../scene.yaml"}, [] {
        std::filesystem::create_directory("gone");
        std::filesystem::current_path("gone");
        std::filesystem::remove("../gone");
    });
    EXPECT_EQ(outcome.code, 2) << outcome.err;
}

TEST_F(Command, CheckReportsOverlapsAndNodesBesideTheMaster) {
    const Outcome outcome = osculate({"check", press, "--set", "bodies.cap.mesh.block.origin=[1.5 m, 0.45 m, 0.98 m]"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    // of the cap's columns at x = 1.5, 1.83, 2.17 and 2.5 the last two hang over, but facets of the third do in part
    EXPECT_THAT(outcome.out,
                AllOf(HasSubstr("  12 slave nodes above the master, initial gap -0.02 m to -0.02 m\n"),
                      HasSubstr("  worst overlap 0.02 m at node 0 of body 'cap', 0.04 of the facet size\n")));
}

TEST_F(Command, CheckAdvisesOnSlaveMasterAndWeighting) {
    const std::string foundation = scene_file("configs/paper/foundation_tri.yaml"), advice = "advice: ";
    const auto checked = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"check", foundation, "--set", "contact.base.discretisation=node"});
        return osculate(arguments).out;
    };
    EXPECT_THAT(checked({}),
                AllOf(HasSubstr(advice + "the meshes do not match"), Not(HasSubstr("times as far apart"))));
    EXPECT_THAT(checked({"--set", "contact.base.slave=ground", "--set", "contact.base.master.set=underside"}),
                HasSubstr(advice + "the slave's nodes are 2 times as far apart as the master's"));
    for (const char* averages : {"mortar", "petrov_galerkin", "automatic"})
        EXPECT_THAT(checked({"--set", std::string("contact.base.discretisation=") + averages}), Not(HasSubstr(advice)));
    EXPECT_THAT(checked({"--set", "bodies.soil.mesh.block.divisions=[50, 50, 2]", "--set",
                         "bodies.soil.mesh.block.pattern=quad"}),
                Not(HasSubstr(advice))); // node on node
}

TEST_F(Command, ExplainSaysWhatIsThereAndWhatIsLeftOut) {
    const Outcome outcome = osculate({"explain", press, "--set", "contact.joint.friction=0"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const std::size_t left_out = outcome.out.find("left out: ");
    ASSERT_NE(left_out, std::string::npos);
    const std::string present = outcome.out.substr(0, left_out), absent = outcome.out.substr(left_out);
    EXPECT_THAT(present, AllOf(HasSubstr("in the plan: "), HasSubstr("\n  contact "), Not(HasSubstr("\n  friction "))));
    EXPECT_THAT(present, testing::ContainsRegex("contact +[0-9.]+ kB, 16 slave nodes an iteration +1 pair"));
    EXPECT_THAT(absent, AllOf(HasSubstr("no pair has mu > 0\n"), HasSubstr("iterations.csv")));
}

TEST_F(Command, KeysListsEveryKeyAtOrBelowAPath) {
    const Outcome all = osculate({"keys"}), some = osculate({"keys", "contact.joint.master.surface.rpim"});
    EXPECT_EQ(all.code, 0);
    EXPECT_EQ(some.code, 0);
    EXPECT_THAT(all.out, AllOf(HasSubstr("\nsolver.tolerance\n"), HasSubstr(some.out)));
    EXPECT_THAT(some.out, AllOf(HasSubstr("rpim.ring\n"), Not(HasSubstr("solver"))));
}

TEST_F(Command, VersionIsTheProjects) {
    const Outcome outcome = osculate({"--version"});
    EXPECT_EQ(outcome.code, 0);
    ASSERT_THAT(outcome.out, testing::MatchesRegex("osculate [0-9]+\\.[0-9]+\\.[0-9]+\n"));
    const std::string number = outcome.out.substr(9, outcome.out.size() - 10);
    EXPECT_THAT(content(scene_file("CMakeLists.txt")), HasSubstr("project(osculate VERSION " + number + " "));
}

TEST_F(Command, HelpIsNoError) {
    const Outcome outcome = osculate({"run", "--help"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_THAT(outcome.out,
                AllOf(HasSubstr("SCENE"), HasSubstr("--set"), HasSubstr("--threads"), HasSubstr("--quiet")));
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
