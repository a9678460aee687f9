/// Runs that end before their time, and what they leave to go on from.

#include "scenes/program.hpp"

#include <chrono>
#include <csignal>
#include <gmock/gmock.h>
#include <map>
#include <nlohmann/json.hpp>
#include <thread>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::IsEmpty;

const std::string press = scene_file("tests/scenes/press.yaml");

/// Contents by path of all files whose bytes a run decides: not the clock's, not the list of them.
std::map<std::string, std::string> files_of(const fs::path& run) {
    std::map<std::string, std::string> files;
    for (const auto& entry : fs::recursive_directory_iterator(run)) {
        const std::string name = fs::relative(entry.path(), run).string();
        if (entry.is_regular_file() && name != "summary.json" && name != "osculate_manifest.txt" &&
            !name.starts_with("checkpoint"))
            files[name] = content(entry.path());
    }
    return files;
}

/// Names of files that one run has and the other has not, or that differ.
std::vector<std::string> differing(const fs::path& a, const fs::path& b) {
    const auto left = files_of(a), right = files_of(b);
    std::vector<std::string> names;
    for (const auto& [name, bytes] : left)
        if (!right.contains(name) || right.at(name) != bytes) names.push_back(name);
    for (const auto& [name, bytes] : right)
        if (!left.contains(name)) names.push_back(name);
    return names;
}

nlohmann::json summary_of(const fs::path& run) {
    return nlohmann::json::parse(content(run / "summary.json"));
}

class Resume : public Program {
protected:
    /// Takes rows, frames and the record of the end away, as if the run had been killed after the checkpoint and half of a row.
    static void break_off(const fs::path& run) {
        std::ofstream(run / "history.csv", std::ios::app) << "0.5,0.1";
        fs::remove(run / "summary.json");
        std::ofstream(run / "frames" / "cap_00003.vtu.part") << "<VTK";
    }
    Outcome resume(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"resume", "run", "--quiet"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return osculate(arguments);
    }
};

TEST_F(Resume, LeavesTheFilesOfTheRunThatWasNotBroken) {
    const std::vector<std::string> all{"--set", "output.iterations=true", "--quiet"};
    std::vector<std::string> whole{"run", press, "-o", "whole"},
        broken{"run", press, "-o", "run", "--checkpoint-every", "2"};
    whole.insert(whole.end(), all.begin(), all.end());
    broken.insert(broken.end(), all.begin(), all.end());
    ASSERT_EQ(osculate(whole).code, 0);
    ASSERT_EQ(osculate(broken).code, 0);
    EXPECT_THAT(differing(folder / "run", folder / "whole"), IsEmpty()); // checkpoints change nothing
    ASSERT_TRUE(fs::exists(folder / "run/checkpoint/state.previous"));
    for (const char* from : {"run/checkpoint/state", "run/checkpoint/state.previous"}) {
        fs::copy_file(folder / from, folder / "kept", fs::copy_options::overwrite_existing);
        break_off(folder / "run");
        if (std::string(from).ends_with("previous")) // of step 2
            std::ofstream(folder / "run/frames/cap_00004.vtu", std::ios::trunc) << "<VTK";
        const Outcome outcome = resume({"--from", "kept"});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_THAT(differing(folder / "run", folder / "whole"), IsEmpty()) << from;
        const auto a = summary_of(folder / "run"), b = summary_of(folder / "whole");
        for (const char* same : {"status", "steps", "iterations", "checks", "plan"})
            EXPECT_EQ(a[same], b[same]) << same;
    }
}

/// Nodes to condense on come as contact moves: they are part of what a run goes on from.
TEST_F(Resume, GoesOnWithTheNodesThatContactHasReached) {
    const std::vector<std::string> slide{scene_file("tests/scenes/general_slide.yaml"), "--quiet"};
    std::vector<std::string> whole{"run", "-o", "whole"}, broken{"run", "-o", "run", "--checkpoint-every", "5"};
    for (auto* run : {&whole, &broken}) run->insert(run->end(), slide.begin(), slide.end());
    ASSERT_EQ(osculate(whole).code, 0);
    ASSERT_EQ(summary_of(folder / "whole")["gmres_iterations"], 0) << "all solves are condensed";
    ASSERT_EQ(osculate(broken).code, 0);
    EXPECT_THAT(differing(folder / "run", folder / "whole"), IsEmpty());
    for (const char* from : {"run/checkpoint/state", "run/checkpoint/state.previous"}) {
        fs::copy_file(folder / from, folder / "kept", fs::copy_options::overwrite_existing);
        fs::remove(folder / "run/summary.json");
        const Outcome outcome = resume({"--from", "kept"});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_THAT(differing(folder / "run", folder / "whole"), IsEmpty()) << from;
    }
}

/// Multigrid keeps grids from step to step: contact that was, as all of the block's here, leaves no digit in them, nor does the
/// factorisation that some step of the tool took.
TEST_F(Resume, GoesOnByMultigridToTheLastBit) {
    for (const auto& [name, every] : {std::pair{"rocking_block", "39"}, {"shallow_ironing", "16"}}) {
        const std::string scene = scene_file("configs/extreme/" + std::string(name) + ".yaml");
        std::vector<std::string> whole{"run", scene, "-o", "whole"},
            broken{"run", scene, "-o", "run", "--checkpoint-every", every};
        for (auto* run : {&whole, &broken})
            run->insert(run->end(),
                        {"--quiet", "--set", "solver.linear_solver=multigrid", "--set", "output.iterations=true"});
        ASSERT_EQ(osculate(whole).code, 0);
        ASSERT_EQ(osculate(broken).code, 0);
        EXPECT_THAT(differing(folder / "run", folder / "whole"), IsEmpty()) << name;
        fs::copy_file(folder / "run/checkpoint/state.previous", folder / "kept", fs::copy_options::overwrite_existing);
        fs::remove(folder / "run/summary.json");
        const Outcome outcome = resume({"--from", "kept"});
        ASSERT_EQ(outcome.code, 0) << outcome.err;
        EXPECT_THAT(differing(folder / "run", folder / "whole"), IsEmpty()) << name;
    }
}

TEST_F(Resume, RefusesWhatItCannotGoOnFrom) {
    const auto refusal = [&](const std::vector<std::string>& more = {}) {
        const Outcome outcome = resume(more);
        EXPECT_EQ(outcome.code, 2) << outcome.err;
        return outcome.err;
    };
    EXPECT_THAT(refusal(), HasSubstr("expected the folder of a run, found nothing there"));
    const fs::path files = run(press);
    fs::remove(files / "summary.json"); // it says that nothing is left to do
    EXPECT_THAT(refusal(), HasSubstr("expected a checkpoint, found nothing there; `osculate run --checkpoint-every"));
    ASSERT_EQ(osculate({"run", press, "-o", "run", "--quiet", "--checkpoint-every", "1"}).code, 0);
    fs::remove(files / "summary.json");
    EXPECT_THAT(refusal({"--from", "run/history.csv"}), HasSubstr("it is not a checkpoint of osculate"));
    const std::string good = content(files / "checkpoint/state"), scene = content(files / "scene.yaml");
    std::ofstream(files / "checkpoint/state", std::ios::binary) << good.substr(0, good.size() / 2);
    EXPECT_THAT(refusal(), AllOf(HasSubstr("it is damaged: its checksum does not fit"),
                                 HasSubstr("--from run/checkpoint/state.previous")));
    std::ofstream(files / "checkpoint/state", std::ios::binary) << good;
    std::string other = scene;
    other.replace(other.find("friction: 0.3"), 13, "friction: 0.4");
    std::ofstream(files / "scene.yaml") << other;
    EXPECT_THAT(refusal(), HasSubstr("expected the scene the checkpoint was written for, found another one"));
    std::ofstream(files / "scene.yaml") << scene;
    std::ofstream(files / "history.csv", std::ios::trunc) << "time\n";
    const Outcome lost = resume();
    EXPECT_EQ(lost.code, 3);
    EXPECT_THAT(lost.err, HasSubstr("cannot go on with run/history.csv"));
}

TEST_F(Resume, CheckpointsAreAskedForInStepsOrTime) {
    for (const char* wrong : {"0", "-3", "2.5", "1 m", "often"})
        EXPECT_THAT(osculate({"run", press, "--checkpoint-every", wrong}).err,
                    HasSubstr("expected a number of steps or a time such as '5 min'"))
            << wrong;
    EXPECT_EQ(osculate({"run", press, "-o", "run", "--quiet", "--checkpoint-every", "1 ms"}).code, 0);
    EXPECT_TRUE(fs::exists(folder / "run/checkpoint/state"));
    EXPECT_EQ(osculate({"run", press, "-o", "run", "--quiet"}).code, 0);
    EXPECT_FALSE(fs::exists(folder / "run/checkpoint")) << "that of the run before";
}

/// The signal reaches the run in its steps: at the end of the one under way it stops, and says how to go on.
TEST_F(Resume, AfterASignalLeavesTheFilesOfTheRunThatWasNotInterrupted) {
    const std::vector<std::string> many{"--set", "stages.pull.steps=60", "--quiet"};
    std::vector<std::string> whole{"run", press, "-o", "whole"}, stopped{"run", press, "-o", "run"};
    whole.insert(whole.end(), many.begin(), many.end());
    stopped.insert(stopped.end(), many.begin(), many.end());
    ASSERT_EQ(osculate(whole).code, 0);
    for (const int signal : {SIGINT, SIGTERM}) {
        const Outcome outcome = osculate(stopped, [&] {
            std::thread([signal, pid = getpid()] { // of the program's own process, once it has accepted three steps
                while (fs::exists("run/steps.csv") ? Csv("run/steps.csv").rows.size() < 3 : true)
                    std::this_thread::sleep_for(std::chrono::milliseconds(1));
                kill(pid, signal);
            })
                .detach();
        });
        ASSERT_EQ(outcome.code, 128 + signal) << outcome.err;
        EXPECT_THAT(outcome.err, HasSubstr("`osculate resume run` goes on"));
        EXPECT_EQ(summary_of(folder / "run")["status"], "interrupted");
        EXPECT_LT(Csv(folder / "run/history.csv").rows.size(), 61U);
        const Outcome rest = resume();
        ASSERT_EQ(rest.code, 0) << rest.err;
        EXPECT_THAT(differing(folder / "run", folder / "whole"), IsEmpty());
        fs::remove_all(folder / "run");
    }
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
