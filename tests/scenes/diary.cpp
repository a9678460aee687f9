#include "scenes/program.hpp"

#include <gmock/gmock.h>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string header = "attempt,time,dt,verdict,reason,body,node,value,lambda,iterations\n";

class Diary : public Program {
protected:
    /// What the program says to a run whose steps.csv is `text`.
    Outcome diary(const std::string& text) const {
        std::filesystem::create_directories(folder / "run");
        std::ofstream(folder / "run/steps.csv", std::ios::binary) << text;
        return osculate({"diary", "run"});
    }
    /// The fault of `text`, from the file's name on.
    void expect_refusal(const std::string& text, const std::string& fault) const {
        const Outcome outcome = diary(text);
        EXPECT_EQ(outcome.code, 2);
        EXPECT_EQ(outcome.out, "");
        EXPECT_EQ(outcome.err, "run/steps.csv:" + fault + "\n");
    }
};

TEST_F(Diary, ShowsEveryAttemptAndSumsUpByReason) {
    const Outcome outcome = diary(header + "1,0.1,0.1,accept,none,,,3.5e-11,1,4\n"
                                           "2,0.3,0.2,retry,interpenetration,ball,12,-0.02,0.5,3\n"
                                           "3,0.2,0.1,retry,solver,plate,7,0.3,0.5,30\n"
                                           "4,0.15,0.05,retry,interpenetration,ball,12,-0.011,0.9,2\n"
                                           "5,0.145,0.045,retry,interpenetration,ball,3,-0.0105,0.9,1\n"
                                           "6,0.1405,0.0405,accept,none,,,1e-12,1,10\n");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(
        outcome.out,
        "attempt    time      dt  verdict  reason            where                     value  lambda  iterations\n"
        "      1     0.1     0.1  accept   -                 -                       3.5e-11       1           4\n"
        "      2     0.3     0.2  retry    interpenetration  node 12 of body 'ball'    -0.02     0.5           3\n"
        "      3     0.2     0.1  retry    solver            node 7 of body 'plate'      0.3     0.5          30\n"
        "      4    0.15    0.05  retry    interpenetration  node 12 of body 'ball'   -0.011     0.9           2\n"
        "      5   0.145   0.045  retry    interpenetration  node 3 of body 'ball'   -0.0105     0.9           1\n"
        "      6  0.1405  0.0405  accept   -                 -                         1e-12       1          10\n"
        "\n"
        "attempts: 6, accepted 2, rejected 4; iterations: 50, lost in rejected attempts 36 (72 %)\n"
        "accepted up to 0.1405 s, in steps of 0.0405 s to 0.1 s\n"
        "rejected for      attempts  iterations lost  smallest dt  to time  most often at\n"
        "interpenetration         3                6        0.045    0.145  node 12 of body 'ball' (2 of 3)\n"
        "solver                   1               30          0.1      0.2  node 7 of body 'plate' (1 of 1)\n");
}

TEST_F(Diary, SaysWhereARunGaveUp) {
    const Outcome outcome = diary(header + "1,0.1,0.1,retry,solver,cap,5,nan,0.5,30\n"
                                           "2,0.05,0.05,give_up,solver,cap,5,inf,0.5,30\n");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out,
                AllOf(HasSubstr("accepted 0, rejected 2;"),
                      HasSubstr("\ngave up on the step of 0.05 s to 0.05 s, for solver at node 5 of body 'cap'\n"),
                      HasSubstr(" nan "), HasSubstr(" inf ")));
}

TEST_F(Diary, ReadsNamesThatHoldSeparators) {
    const Outcome outcome = diary(header + "1,1,1,retry,energy,\"a, \"\"b\"\"\",4,2,0.5,3\r\n");
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("node 4 of body 'a, \"b\"'"));
}

TEST_F(Diary, OfARunThatHasJustBegunIsEmpty) {
    EXPECT_EQ(diary(header).out, "no attempt yet\n");
}

TEST_F(Diary, ReadsWhatARunWrites) {
    const Csv steps(run(scene_file("tests/scenes/press.yaml")) / "steps.csv");
    const Outcome outcome = osculate({"diary", "run"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("attempts: " + std::to_string(steps.rows.size()) + ", accepted 4, "),
                                   HasSubstr("\naccepted up to 4 s, in steps of 1 s to 1 s\n"),
                                   HasSubstr("\nno attempt was rejected\n")));
}

TEST_F(Diary, RefusesAFolderWithoutARun) {
    Outcome outcome = osculate({"diary", "nowhere"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.err, "nowhere: expected the folder of a run, found nothing of that name\n");
    std::filesystem::create_directory(folder / "empty");
    outcome = osculate({"diary", "empty"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.err, "empty: expected the folder of a run, which holds steps.csv, found none in it\n");
    std::ofstream(folder / "scene.yaml") << "bodies: {}\n";
    outcome = osculate({"diary", "scene.yaml"});
    EXPECT_EQ(outcome.code, 2);
    EXPECT_EQ(outcome.err, "scene.yaml: expected the folder of a run, found a file\n");
    EXPECT_EQ(osculate({"diary"}).code, 2);
}

TEST_F(Diary, RefusesAnotherKindOfFile) {
    const std::string expected = "1:1: expected the column names " + header.substr(0, header.size() - 1) + ", found ";
    expect_refusal("time,dt,iterations\n1,1,3\n", expected + "'time,dt,iterations'");
    expect_refusal("", expected + "an empty file");
}

TEST_F(Diary, NamesEveryDamagedLineAndWhatWasExpectedThere) {
    expect_refusal(header + "1,1,1,acept,none,,,0,1,3\n", "2:7: verdict: expected one of accept, retry, give_up, found "
                                                          "'acept' (did you mean 'accept'?)");
    expect_refusal(header + "1,1,1,retry,weather,,,0,1,3\n",
                   "2:13: reason: expected one of none, interpenetration, solver, error, energy, collision, audit, "
                   "distance, reach, impact, forced, found 'weather'");
    expect_refusal(header + "1,1,0,accept,none,,,0,1,3\n", "2:5: dt: expected a time in s, > 0, found '0'");
    expect_refusal(header + "1,nan,1,accept,none,,,0,1,3\n", "2:3: time: expected a time in s, found 'nan'");
    expect_refusal(header + "1,1,1,retry,solver,cap,x,0,1,3\n",
                   "2:24: node: expected a whole number >= 0, or nothing, found 'x'");
    expect_refusal(header + "1,1,1,retry,solver,cap,5,0,1,\n",
                   "2:30: iterations: expected a whole number >= 0, found ''");
    expect_refusal(header + "1,1,1,accept,none,,,0,1,3\n2,2,1,accept\nx,3,1,accept,none,,,0,1,3\n",
                   "3:1: expected 10 cells: " + header.substr(0, header.size() - 1) +
                       ", found 4 in '2,2,1,accept'\n"
                       "run/steps.csv:4:1: attempt: expected a whole number >= 0, found 'x'");
}

TEST_F(Diary, SaysWhenTheFileHasBeenCutOff) {
    expect_refusal(
        header + "1,1,1,accept,none,,,0,1,1",
        "2:1: expected a line end, found '1,1,1,accept,none,,,0,1,1', where the file stops: it has been cut off");
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
