/// Where the program writes, what it takes away there, and what a text of a scene can do to a script: nothing.

#include "scenes/program.hpp"

#include <chrono>
#include <csignal>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <thread>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const std::string press = scene_file("tests/scenes/press.yaml");

class OutputFolders : public Program {
protected:
    void mine(const std::string& file) const {
        fs::create_directories((folder / file).parent_path());
        std::ofstream(folder / file) << "mine";
    }
    /// Whether a file is as `mine` wrote it.
    [[nodiscard]] bool is_mine(const std::string& file) const { return content(folder / file) == "mine"; }
    Outcome press_into(const std::string& output, std::vector<std::string> more = {}) const {
        more.insert(more.begin(), {"run", press, "-o", output, "--quiet"});
        return osculate(more);
    }
};

const std::vector<std::string> others{"run/checkpoint/thesis.txt", "run/plots/mine.csv", "run/probes/mine.csv",
                                      "run/frames/mine.vtu",       "run/history.csv",    "run/scene.yaml"};

TEST_F(OutputFolders, OfOtherFilesAreRefusedAndLeftAlone) {
    for (const std::string& file : others) mine(file);
    const Outcome outcome = press_into("run");
    EXPECT_EQ(outcome.code, 2);
    EXPECT_THAT(outcome.err,
                AllOf(HasSubstr("run: expected a folder that is absent, is empty or holds the osculate_manifest.txt"),
                      HasSubstr("found 'checkpoint/', 'frames/', 'history.csv', 'plots/' and 2 more"),
                      HasSubstr("--force")));
    for (const std::string& file : others) EXPECT_TRUE(is_mine(file)) << file;
}

TEST_F(OutputFolders, ForcedIntoTheyLoseOnlyWhatIsWritten) {
    for (const std::string& file : others) mine(file);
    EXPECT_EQ(press_into("run", {"--force"}).code, 0);
    for (const std::string& file : others)
        EXPECT_EQ(is_mine(file), file != "run/history.csv" && file != "run/scene.yaml") << file;
}

TEST_F(OutputFolders, OfAnEarlierRunKeepWhatWasAdded) {
    ASSERT_EQ(press_into("run", {"--set", "output.report=true"}).code, 0);
    ASSERT_TRUE(fs::exists(folder / "run/report.html"));
    for (const char* file : {"run/notes.txt", "run/frames/mine.vtu", "run/frames/cap_mine.vtu", "run/report/mine.png"})
        mine(file);
    ASSERT_EQ(press_into("run", {"--set", "output.frame_every=0"}).code, 0);
    for (const char* file : {"run/notes.txt", "run/frames/mine.vtu", "run/frames/cap_mine.vtu", "run/report/mine.png"})
        EXPECT_TRUE(is_mine(file)) << file;
    for (const char* file : {"run/report.html", "run/series.pvd", "run/frames/cap_00000.vtu"})
        EXPECT_FALSE(fs::exists(folder / file)) << file << " is of the run before";
    mine("run/summary.json.mine");
    mine("run/probes/here.csv");
    const Outcome clash =
        press_into("run", {"--set", "output.probes={here: {point: {body: cap, at: [0.5, 0.5, 1.2]}}}"});
    EXPECT_EQ(clash.code, 2) << clash.err;
    EXPECT_THAT(clash.err, HasSubstr("found 'probes/here.csv'; "));
    EXPECT_TRUE(fs::exists(folder / "run/history.csv")) << "a run that is refused takes nothing away";
}

TEST_F(OutputFolders, AreNumberedWhenAskedTo) {
    mine("run/notes.txt");
    const Outcome first = press_into("run", {"--new"}), second = press_into("run", {"--new"});
    EXPECT_EQ(first.out + second.out, "run-2\nrun-3\n");
    for (const char* run : {"run-2", "run-3"}) EXPECT_TRUE(fs::exists(folder / run / "summary.json"));
    EXPECT_EQ(press_into("run", {"--new", "--force"}).code, 2) << "one or the other";
}

TEST_F(OutputFolders, ListEveryFileOfARunWheneverItIsKilled) {
    // every file that there is has to be listed, at any moment
    const auto unlisted = [&] {
        std::vector<std::string> names;
        const std::string list = content(folder / "run/osculate_manifest.txt");
        for (const auto& entry : fs::recursive_directory_iterator(folder / "run")) {
            std::string name = fs::relative(entry.path(), folder / "run").string();
            if (name.ends_with(".part")) name.resize(name.size() - 5);
            if (entry.is_regular_file() && !name.starts_with("osculate_manifest.txt") &&
                list.find("\n" + name + "\n") == std::string::npos)
                names.push_back(name);
        }
        return names;
    };
    for (const int milliseconds : {20, 60, 100, 150, 200, 300}) {
        const pid_t child = start({"run", press, "-o", "run", "--quiet", "--set", "stages.pull.steps=2000",
                                   "--checkpoint-every", "3", "--set", "output.template=everything"});
        for (int i = 0; i < 2000 && !fs::exists(folder / "run/history.csv"); ++i)
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
        std::this_thread::sleep_for(std::chrono::milliseconds(milliseconds));
        kill(child, SIGKILL);
        waitpid(child, nullptr, 0);
        EXPECT_THAT(unlisted(), testing::IsEmpty());
    }
    mine("run/notes.txt");
    mine("run/osculate_manifest.txt.4194304.part"); // of a process killed as it wrote one
    ASSERT_EQ(press_into("run", {"--set", "output.frame_every=0", "--set", "output.template=minimal"}).code, 0);
    std::set<std::string> left;
    for (const auto& entry : fs::directory_iterator(folder / "run")) left.insert(entry.path().filename());
    EXPECT_THAT(left, ElementsAre("history.csv", "notes.txt", "osculate_manifest.txt", "scene.yaml", "steps.csv",
                                  "summary.json"));
}

TEST_F(OutputFolders, HaveOneRunAtATime) {
    const pid_t child =
        start({"run", press, "-o", "run", "--quiet", "--checkpoint-every", "1", "--set", "stages.pull.steps=20000"});
    for (int i = 0; i < 2000 && !fs::exists(folder / "run/checkpoint/state"); ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    for (const std::vector<std::string>& words : {std::vector<std::string>{"run", press, "-o", "run"},
                                                  {"run", press, "-o", "run", "--force"},
                                                  {"resume", "run"}}) {
        const Outcome second = osculate(words);
        EXPECT_EQ(second.code, 2);
        EXPECT_THAT(second.err,
                    HasSubstr("run: expected a folder that no other process of osculate writes into, found process " +
                              std::to_string(child) + " at work in it"));
    }
    EXPECT_EQ(osculate({"report", "run"}).code, 0) << "a report is made of a run that is going on, too";
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    EXPECT_EQ(press_into("run").code, 0) << "the system ends the lock";
}

TEST_F(OutputFolders, OfSurfacesAndStudiesAreTheSame) {
    mine("s/notes.txt");
    std::ofstream(folder / "small.yaml")
        << "scene: " << press
        << "\naxes: {friction: {key: contact.joint.friction, values: [0.1]}}\n"
           "quantities: {weight: {contact: joint, value: sum(force_z), reference: 1e5}}\n";
    std::ofstream(folder / "surfaces.yaml")
        << "surfaces: {ball-1: {shape: {sphere: {radius: 1}}}}\n"
           "meshes: {refined: {coarsest: 4, levels: 2}}\nmethods: [facets]\npoints: 1\n";
    for (const std::vector<std::string>& words : {std::vector<std::string>{"surface", press},
                                                  {"study", "small.yaml", "--report-only"},
                                                  {"study", "surfaces.yaml"}}) {
        std::vector<std::string> into = words, numbered = words;
        into.insert(into.end(), {"-o", "s"});
        numbered.insert(numbered.end(), {"-o", "s", "--new"});
        const Outcome refused = osculate(into);
        EXPECT_EQ(refused.code, 2) << words[0];
        EXPECT_THAT(refused.err, HasSubstr("s: expected a folder that is absent, is empty"));
        const Outcome other = osculate(numbered);
        EXPECT_EQ(other.code, 0) << other.err;
        EXPECT_THAT(other.out, testing::ContainsRegex("s-[234]"));
        into.emplace_back("--force");
        EXPECT_EQ(osculate(into).code, 0);
        EXPECT_EQ(osculate(into).code, 0);
        EXPECT_TRUE(is_mine("s/notes.txt"));
        fs::remove(folder / "s/osculate_manifest.txt");
    }
    ASSERT_EQ(osculate({"surface", press}).code, 0);
    EXPECT_EQ(osculate({"run", press, "--quiet"}).code, 0) << "out/press/surface is in the folder of the run";
    EXPECT_TRUE(fs::exists(folder / "out/press/surface/joint.vtp"));
}

TEST_F(OutputFolders, OfACompleteRunAreLeftAsTheyAre) {
    ASSERT_EQ(press_into("run", {"--checkpoint-every", "2"}).code, 0);
    const auto before = fs::last_write_time(folder / "run/history.csv");
    const Outcome outcome = osculate({"resume", "run"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.out, "the run in run is complete; there is nothing left to do\n");
    EXPECT_EQ(osculate({"resume", "run", "--quiet"}).out, "");
    EXPECT_EQ(fs::last_write_time(folder / "run/history.csv"), before);
}

TEST_F(OutputFolders, OfAVersionWithoutManifestsAreResumedAndReportedOn) {
    ASSERT_EQ(press_into("run", {"--checkpoint-every", "2"}).code, 0);
    const std::string history = content(folder / "run/history.csv");
    for (const char* file : {"osculate_manifest.txt", "summary.json"}) fs::remove(folder / "run" / file);
    mine("run/frames/mine.vtu");
    EXPECT_EQ(osculate({"report", "run"}).code, 0);
    const Outcome resumed = osculate({"resume", "run", "--quiet"});
    EXPECT_EQ(resumed.code, 0) << resumed.err;
    EXPECT_EQ(content(folder / "run/history.csv"), history);
    EXPECT_TRUE(is_mine("run/frames/mine.vtu"));
    EXPECT_EQ(press_into("run").code, 0) << "its files are listed now";
    EXPECT_TRUE(is_mine("run/frames/mine.vtu"));
}

class Scripts : public Program {};

TEST_F(Scripts, GetNoCommandsFromAScene) {
    const std::string plot = "{force: {TEXT: \"forces\\n!touch touched\\n\", curves: {one: {y: time}}}}";
    for (const char* key : {"title", "x_label", "y_label"}) {
        std::string plots = plot;
        plots.replace(plots.find("TEXT"), 4, key);
        std::string scene = content(press);
        const std::string output = "output: {template: contact}";
        scene.replace(scene.find(output), output.size(), "output: {plots: " + plots + "}");
        std::ofstream(folder / "scene.yaml") << scene;
        for (const char* command : {"run", "check"}) {
            const Outcome outcome = osculate({command, "scene.yaml"});
            EXPECT_EQ(outcome.code, 2);
            EXPECT_THAT(outcome.err,
                        AllOf(HasSubstr("scene.yaml:"), HasSubstr(std::string("output.plots.force.") + key),
                              HasSubstr("expected a text on one line"), HasSubstr("'forces\\n!touch")));
        }
    }
    EXPECT_FALSE(fs::exists(folder / "touched"));
    EXPECT_FALSE(fs::exists(folder / "out"));
}

TEST_F(Scripts, DrawWhateverATextSays) {
    if (std::system("command -v gnuplot >/dev/null") != 0) GTEST_SKIP() << "gnuplot is not installed";
    const std::string plots =
        "{force: {title: '''', x_label: 'ends in \\', y_label: '\"`touch touched` {$ % @x #', curves: "
        "{one: {y: time}}}}";
    const Outcome outcome = osculate(
        {"run", press, "-o", "my 'run'", "--quiet", "--set", "output.plots=" + plots, "--set", "output.report=true"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.err, "");
    for (const char* picture : {"plots/force.svg", "plots/force.png", "report/reactions.svg"})
        EXPECT_TRUE(fs::exists(folder / "my 'run'" / picture)) << picture;
    EXPECT_THAT(content(folder / "my 'run'/plots/force.svg"), HasSubstr("ends in \\"));
    for (const auto& entry : fs::recursive_directory_iterator(folder)) EXPECT_NE(entry.path().filename(), "touched");
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
