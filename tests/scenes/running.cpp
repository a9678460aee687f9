#include "osculate/mesh/vtu_reader.hpp"
#include "scenes/program.hpp"

#include <csignal>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>
#include <set>
#include <sys/resource.h>
#include <yaml-cpp/yaml.h>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;

const std::string press = scene_file("tests/scenes/press.yaml");

/// Relative to the largest force: the tolerance of the solver is 1e-9, its last iteration gains far more.
constexpr double balance = 1e-8;

std::set<std::string> names_in(const fs::path& folder) {
    std::set<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder)) names.insert(entry.path().filename().string());
    return names;
}

nlohmann::json summary_in(const fs::path& folder) {
    return nlohmann::json::parse(content(folder / "summary.json"));
}

class Run : public Program {};

TEST_F(Run, LeavesTheFilesOfTheContract) {
    const fs::path files = run(press, {"output.iterations=true"});
    EXPECT_THAT(names_in(files),
                ElementsAre("frames", "history.csv", "iterations.csv", "osculate_manifest.txt", "scene.yaml",
                            "series.pvd", "show_in_paraview.py", "steps.csv", "summary.json"));
    std::set<std::string> frames;
    for (const char* part : {"base_0000?.vtu", "cap_0000?.vtu", "joint.slave_0000?.vtp", "joint.master_0000?.vtp"})
        for (const char number : {'0', '1', '2', '3', '4'}) {
            std::string name = part;
            name[name.find('?')] = number;
            frames.insert(name);
        }
    EXPECT_EQ(names_in(files / "frames"), frames);
}

TEST_F(Run, HistoryHasTheColumnsOfTheContract) {
    const Csv history(run(press) / "history.csv");
    EXPECT_THAT(history.columns,
                ElementsAre("time", "dt", "iterations", "pair.joint.force_x", "pair.joint.force_y",
                            "pair.joint.force_z", "pair.joint.normal", "pair.joint.friction", "pair.joint.moment_x",
                            "pair.joint.moment_y", "pair.joint.moment_z", "pair.joint.area", "pair.joint.open",
                            "pair.joint.stick", "pair.joint.slip", "pair.joint.penetration", "set.bed.reaction_x",
                            "set.bed.reaction_y", "set.bed.reaction_z", "set.side.reaction_x", "set.side.reaction_y",
                            "set.side.reaction_z", "set.rear.reaction_x", "set.rear.reaction_y",
                            "set.rear.reaction_z"));
    ASSERT_EQ(history.rows.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(history.number(i, "time"), static_cast<double>(i + 1));
        EXPECT_EQ(history.number(i, "dt"), 1);
        EXPECT_EQ(history.number(i, "pair.joint.open") + history.number(i, "pair.joint.stick") +
                      history.number(i, "pair.joint.slip"),
                  16);
    }
}

TEST_F(Run, ResultantsFollowFromPressureAndFriction) {
    const Csv history(run(press) / "history.csv");
    const std::size_t last = 3;
    const double N = 1e5; // 100 kPa on 1 m^2
    EXPECT_NEAR(history.number(last, "pair.joint.force_z"), N, balance * N);
    EXPECT_NEAR(history.number(last, "pair.joint.friction"), 0.3 * history.number(last, "pair.joint.normal"),
                balance * N)
        << "every node slips";
    EXPECT_NEAR(history.number(last, "pair.joint.area"), 1, 1e-12);
    EXPECT_LT(history.number(last, "pair.joint.penetration"), 1e-9);
    // M_x = y F_z - z F_y about the origin: the resultant stays near the middle of the cap, at y = 0.95
    EXPECT_NEAR(history.number(last, "pair.joint.moment_x") / N, 0.95, 1e-3);
}

TEST_F(Run, ReactionsBalanceThePairForceWhereSetsShareNodes) {
    const Csv history(run(press) / "history.csv");
    for (std::size_t i = 0; i < history.rows.size(); ++i)
        for (const char* axis : {"_x", "_y", "_z"}) {
            const auto value = [&](const std::string& name) { return history.number(i, name + axis); };
            EXPECT_NEAR(value("set.bed.reaction") + value("set.side.reaction"), value("pair.joint.force"),
                        balance * 1e5);
            if (std::string(axis) != "_z") { // the pressure acts along z
                EXPECT_NEAR(value("set.rear.reaction"), -value("pair.joint.force"), balance * 1e5);
            }
        }
}

TEST_F(Run, CountsEveryAttempt) {
    // pulled off the base: a step fails, is cut, and the run gives up
    const Outcome outcome = osculate({"run", press, "-o", "run", "--set", "stages.pull.displacement.rear.x=6 m",
                                      "--set", "solver.smallest_step=0.3", "--set", "output.iterations=true"});
    EXPECT_EQ(outcome.code, 3);
    EXPECT_THAT(outcome.err, HasSubstr("the run gave up: stage 'pull'"));
    const fs::path files = folder / "run";
    const Csv steps(files / "steps.csv"), history(files / "history.csv"), iterations(files / "iterations.csv");
    EXPECT_THAT(steps.columns, ElementsAre("attempt", "time", "dt", "verdict", "reason", "body", "node", "value",
                                           "lambda", "iterations"));
    EXPECT_THAT(iterations.columns, ElementsAre("attempt", "iteration", "residual", "status_changes", "open", "stick",
                                                "slip", "facet_changes"));
    long accepted = 0, rejected = 0, newton = 0;
    for (std::size_t i = 0; i < steps.rows.size(); ++i) {
        EXPECT_EQ(steps.number(i, "attempt"), static_cast<double>(i + 1));
        const std::string verdict = steps.text(i, "verdict");
        EXPECT_EQ(steps.text(i, "reason") == "none", verdict == "accept");
        ++(verdict == "accept" ? accepted : rejected);
        newton += std::stol(steps.text(i, "iterations"));
    }
    EXPECT_GE(accepted, 1);
    EXPECT_GE(rejected, 1);
    EXPECT_EQ(steps.text(steps.rows.size() - 1, "verdict"), "give_up");
    EXPECT_EQ(steps.text(steps.rows.size() - 1, "reason"), "solver") << "nothing holds the cap";
    EXPECT_EQ(iterations.text(iterations.rows.size() - 1, "attempt"), steps.text(steps.rows.size() - 1, "attempt"));

    EXPECT_EQ(static_cast<long>(history.rows.size()), accepted);
    EXPECT_TRUE(fs::exists(files / "frames" / "cap_00001.vtu")) << "what was accepted is kept";
    const auto summary = summary_in(files);
    EXPECT_EQ(summary["status"], "gave_up");
    EXPECT_THAT(summary["failure"].get<std::string>(), HasSubstr("stage 'pull'"));
    EXPECT_EQ(summary["steps"]["accepted"], accepted);
    EXPECT_EQ(summary["steps"]["rejected"], rejected);
    EXPECT_EQ(summary["iterations"], newton);
}

TEST_F(Run, SummarySaysWhatItWasAndWhatItCost) {
    const auto summary = summary_in(run(press));
    EXPECT_EQ(summary["status"], "done");
    EXPECT_EQ(summary["scene"], "press");
    EXPECT_EQ(summary["dofs"], 272);
    EXPECT_EQ(summary["bodies"][1]["name"], "cap");
    EXPECT_EQ(summary["bodies"][1]["elements"], 18);
    EXPECT_EQ(summary["pairs"][0]["slave_nodes"], 16);
    EXPECT_EQ(summary["pairs"][0]["surface"], "facets");
    EXPECT_EQ(summary["steps"]["accepted"], 4);
    EXPECT_GT(summary["factorisations"], 0);
    EXPECT_GT(summary["peak_memory_bytes"], 1e6);
    const auto& seconds = summary["seconds"];
    double parts = 0;
    for (const char* part : {"search", "patches", "contact", "assembly", "factor", "solve", "output"}) {
        EXPECT_GT(seconds[part], 0) << part;
        parts += seconds[part].get<double>();
    }
    EXPECT_LE(parts, seconds["total"]) << "no time is counted twice";
}

TEST_F(Run, ResolvedSceneGivesTheSameRun) {
    // with what the paper's scenes have and this one lacks: a smooth master, changed from outside
    const fs::path files = run(press, {"contact.joint.surface=rpim", "contact.joint.friction=0.2"});
    fs::rename(files, folder / "first");
    run((folder / "first" / "scene.yaml").string());
    EXPECT_EQ(content(folder / "run" / "history.csv"), content(folder / "first" / "history.csv"));
    EXPECT_EQ(content(folder / "run" / "scene.yaml"), content(folder / "first" / "scene.yaml"));
    const YAML::Node scene = YAML::LoadFile(folder / "run" / "scene.yaml");
    EXPECT_EQ(scene["contact"]["joint"]["friction"].as<double>(), 0.2);
    EXPECT_EQ(scene["contact"]["joint"]["master"]["surface"]["rpim"]["ring"].as<int>(), 2);
}

TEST_F(Run, ResultsDoNotDependOnThreads) {
    const std::vector<std::string> common{"run", press, "--quiet"};
    for (const char* threads : {"1", "3"}) {
        std::vector<std::string> arguments = common;
        arguments.insert(arguments.end(), {"--threads", threads, "-o", threads, "--set",
                                           "bodies.cap.mesh.block.divisions=[10, 10, 1]"}); // enough nodes to share out
        ASSERT_EQ(osculate(arguments).code, 0);
    }
    EXPECT_EQ(content(folder / "1" / "history.csv"), content(folder / "3" / "history.csv"));
}

TEST_F(Run, FramesHoldTheBodiesAndTheSeriesListsThem) {
    const fs::path files = run(press);
    for (const char* frame : {"base_00000.vtu", "base_00004.vtu"}) {
        const mesh::Mesh base = mesh::read_vtu((files / "frames" / frame).string());
        EXPECT_EQ(base.node_count(), 75);
        EXPECT_EQ(base.element_count(), 32);
    }
    const std::string series = content(files / "series.pvd");
    for (const std::string& name : names_in(files / "frames"))
        EXPECT_THAT(series, HasSubstr("file=\"frames/" + name + "\""));
    EXPECT_THAT(content(files / "frames" / "joint.slave_00004.vtp"),
                AllOf(HasSubstr("PolyData"), HasSubstr("\"gap\""), HasSubstr("\"contact_force\""),
                      HasSubstr("\"normal_stress\""), HasSubstr("\"slip\""), HasSubstr("\"status\""),
                      HasSubstr("\"normal\""), HasSubstr("\"displacement\"")));
}

TEST_F(Run, FramesAreWrittenAsOftenAsAskedAndAtTheEnd) {
    const fs::path files = run(press, {"output.frame_every=3", "output.slave_fields=[]", "output.master_fields=[]"});
    EXPECT_THAT(names_in(files / "frames"), ElementsAre("base_00000.vtu", "base_00003.vtu", "base_00004.vtu",
                                                        "cap_00000.vtu", "cap_00003.vtu", "cap_00004.vtu"));
    run(press, {"output.frame_every=0"}); // what the run before wrote is gone, too
    EXPECT_THAT(names_in(files),
                ElementsAre("history.csv", "osculate_manifest.txt", "scene.yaml", "steps.csv", "summary.json"));
}

TEST_F(Run, SaysWhereFramesAreOnlyWhereItWritesSome) {
    EXPECT_THAT(osculate({"run", press, "-o", "run"}).out, HasSubstr("see run/series.pvd and run/history.csv"));
    EXPECT_THAT(osculate({"run", press, "-o", "run", "--set", "output.frame_every=0"}).out,
                HasSubstr(" s; see run/history.csv"));
}

TEST_F(Run, MinimalTemplateWritesNothingUnnamed) {
    const fs::path files = run(press, {"output.template=minimal"});
    EXPECT_FALSE(fs::exists(files / "iterations.csv"));
    for (const std::string& name : names_in(files / "frames")) {
        EXPECT_THAT(name, testing::EndsWith(".vtu"));
        EXPECT_THAT(content(files / "frames" / name),
                    AllOf(HasSubstr("\"displacement\""), Not(HasSubstr("\"stress\"")), Not(HasSubstr("\"reaction\""))));
    }
    const Csv history(files / "history.csv");
    EXPECT_EQ(history.columns.back(), "pair.joint.penetration");
}

TEST_F(Run, ReplacesTheRunOfBeforeAndNothingElse) {
    const fs::path files = run(press, {"output.iterations=true", "output.template=contact"});
    std::ofstream(files / "notes.txt") << "mine";
    std::ofstream(files / "frames" / "notes.txt") << "mine too";
    run(press, {"output.template=minimal"});
    EXPECT_THAT(names_in(files), ElementsAre("frames", "history.csv", "notes.txt", "osculate_manifest.txt",
                                             "scene.yaml", "series.pvd", "steps.csv", "summary.json"));
    EXPECT_EQ(names_in(files / "frames").size(), 11U) << "two bodies, five frames and the notes";
    EXPECT_THAT(content(files / "series.pvd"), Not(HasSubstr("joint")));
}

TEST_F(Run, GoesToOutAndTheScenesNameByDefault) {
    const Outcome outcome = osculate({"run", press});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_TRUE(fs::exists(folder / "out" / "press" / "summary.json"));
    EXPECT_THAT(outcome.out, AllOf(HasSubstr("press: 4 steps, "), HasSubstr("out/press/series.pvd")));
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("t 1/4 s, step 1, dt 1 s, Newton "), HasSubstr("t 4/4 s, step 4")));
}

TEST_F(Run, QuietSaysNothing) {
    const Outcome outcome = osculate({"run", press, "--quiet"});
    EXPECT_EQ(outcome.code, 0);
    EXPECT_EQ(outcome.out + outcome.err, "");
}

TEST_F(Run, GivesUpWhenAFileCannotBeWritten) {
    std::ofstream(folder / "taken") << "a file, not a folder";
    const Outcome taken = osculate({"run", press, "-o", "taken"});
    EXPECT_EQ(taken.code, 3);
    EXPECT_THAT(taken.err, AllOf(HasSubstr("the run gave up: "), HasSubstr("taken")));

    for (const char* threads : {"1", "2"}) { // with two, frames are written beside the next step
        const Outcome full = osculate({"run", press, "-o", "full", "--quiet", "--threads", threads}, [] {
            std::signal(SIGXFSZ, SIG_IGN); // writing beyond the limit fails as on a full disk
            const rlimit small{6000, 6000};
            setrlimit(RLIMIT_FSIZE, &small);
        });
        EXPECT_EQ(full.code, 3);
        EXPECT_THAT(full.err, HasSubstr("the run gave up: cannot write full/frames/"));
    }
}

TEST_F(Run, WritesTheSameFilesOnASecondThread) {
    for (const char* threads : {"1", "2"})
        ASSERT_EQ(osculate({"run", press, "-o", threads, "--quiet", "--threads", threads}).code, 0);
    std::size_t files = 0;
    for (const auto& file : fs::recursive_directory_iterator(folder / "1")) {
        const fs::path name = file.path().filename();
        if (!file.is_regular_file() || name == "summary.json" || name == "osculate_manifest.txt")
            continue; // times, processes
        ++files;
        EXPECT_EQ(content(file.path()), content(folder / "2" / file.path().lexically_relative(folder / "1")));
    }
    EXPECT_GT(files, 5U);
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
