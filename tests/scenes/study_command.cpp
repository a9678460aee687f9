/// `osculate study` from file to files, by the program itself: it starts itself anew.

#include "scenes/study.hpp"

#include <chrono>
#include <csignal>
#include <gmock/gmock.h>
#include <map>
#include <regex>
#include <thread>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

using testing::AllOf;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::Not;
using Study = StudyProgram;

TEST_F(Study, HasARowForEveryRun) {
    const std::string file = write(small_study);
    const Outcome outcome = study({file, "-o", "s", "--jobs", "2"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("4 of 4 runs done"));
    EXPECT_THAT(outcome.err, AllOf(HasSubstr("run 4/4"), HasSubstr("ETA 0:00:00")));
    const Csv csv = table_of(folder / "s/study.csv");
    ASSERT_EQ(csv.rows.size(), 4U);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(csv.text(i, "status"), "done");
        EXPECT_EQ(csv.number(i, "parameter.h"), i % 2 == 0 ? 0.5 : 0.25);
        EXPECT_EQ(csv.text(i, "friction"), i < 2 ? "0.1" : "0.3");
        // 100 kPa on 1 m^2; the pull tilts nothing out of balance
        EXPECT_NEAR(csv.number(i, "weight.value"), 1e5, 1e-6 * 1e5) << "the solver's tolerance is 1e-9";
        EXPECT_GT(csv.number(i, "pressure.error"), 0.01) << "a flat punch has singular edges";
        EXPECT_EQ(csv.text(i, "pressure.reference"), "");
        EXPECT_GT(csv.number(i, "cpu_seconds"), 0);
        EXPECT_NEAR(csv.number(i, "dragged.value"), i < 2 ? 0.1 : 0.3, 1e-6);
        EXPECT_GT(csv.number(i, "cap.value"), 1e4) << "stress";
    }
    EXPECT_NE(csv.text(0, "dragged.error"), "") << "against the fine mesh";
    EXPECT_EQ(csv.text(1, "dragged.error"), "") << "which is the reference";
    const std::string report = content(folder / "s/study.md");
    EXPECT_THAT(report, AllOf(HasSubstr("# Pressed and pulled"), HasSubstr("A small one."), HasSubstr("## weight"),
                              HasSubstr("osculate study " + file), HasSubstr("slope over h")));
    EXPECT_THAT(content(folder / "s/study.gp"),
                AllOf(HasSubstr("weight_work.svg"), HasSubstr("weight_convergence.png")));
}

/// The drag of a sliding block is mu P, whatever the mesh: a curve for each, a map, and sensitivities of samples.
TEST_F(Study, ShowsQuantitiesOverItsAxes) {
    const std::string file = write(R"(scene: )" + press_yaml + R"(
axes:
  friction: {key: contact.joint.friction, values: [0.3, 0.1, 0.2]}
  E: {key: bodies.cap.material.linear_elastic.E, values: [10 MPa, 40 MPa]}
  cells: {key: bodies.cap.mesh.block.divisions, values: [[2, 2, 1], [3, 3, 1]]}
quantities:
  drag: {unit: N, history: pair.joint.friction}
plots:
  curves: {drag: {quantity: drag, over: friction}}
  contours: {map: {quantity: drag, over: [friction, E], logarithmic: [y]}}
)");
    const Outcome outcome = study({file, "-o", "s", "--quiet"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const std::string curves = content(folder / "s/drag_curves.csv");
    EXPECT_THAT(curves, HasSubstr("friction,\"E 10 MPa, cells 2-2-1\",\"E 10 MPa, cells 3-3-1\",\"E 40 MPa, cells "
                                  "2-2-1\",\"E 40 MPa, cells 3-3-1\"\n"));
    std::istringstream lines(curves.substr(curves.find('\n') + 1));
    for (const double mu : {0.1, 0.2, 0.3}) { // in the order of their numbers, not of the file
        std::string line;
        std::getline(lines, line);
        std::istringstream cells(line);
        std::string cell;
        std::getline(cells, cell, ',');
        EXPECT_EQ(std::stod(cell), mu);
        while (std::getline(cells, cell, ',')) EXPECT_NEAR(std::stod(cell), mu * 1e5, 1e-3 * mu * 1e5);
    }
    EXPECT_THAT(content(folder / "s/map_contours.csv"),
                AllOf(HasSubstr("others,friction,E,drag\n"), HasSubstr("\ncells 2-2-1,0.1,10,")));
    EXPECT_THAT(content(folder / "s/study.md"), AllOf(HasSubstr("| friction | E 10 MPa, cells 2-2-1 |"),
                                                      HasSubstr("| E, MPa \\\\ friction | 0.1 | 0.2 | 0.3 |")));
    EXPECT_TRUE(fs::exists(folder / "s/drag_curves.svg") || outcome.out.find("no plots") != std::string::npos);
    EXPECT_THAT(outcome.out, Not(HasSubstr("gnuplot failed")));
}

/// A run that is missing leaves a gap, a quantity that does not vary no warning, and one without values no dead link.
TEST_F(Study, DrawsGapsWhereRunsHaveNoValue) {
    const std::string file = write(R"(scene: )" + press_yaml + R"(
axes:
  friction: {key: contact.joint.friction, values: [0.1, 0.2, 0.3]}
  E: {key: bodies.cap.material.linear_elastic.E, values: [10 MPa, 40 MPa]}
leave_out: [{friction: 0.2, E: 10 MPa}]
quantities:
  drag: {unit: N, history: pair.joint.friction}
  flat: {value: 7}
  never: {value: 0 / 0}
plots:
  curves: {drag: {quantity: drag, over: friction}, flat: {quantity: flat, over: E}, never: {quantity: never, over: E}}
  contours: {drag: {quantity: drag, over: [friction, E]}}
)");
    const Outcome outcome = study({file, "-o", "s", "--quiet"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "") << "warnings of gnuplot";
    EXPECT_THAT(content(folder / "s/study.gp"), AllOf(HasSubstr("boxxyerror"), Not(HasSubstr("nan"))));
    EXPECT_THAT(content(folder / "s/drag_curves.csv"), HasSubstr("\n0.2,,"));
    EXPECT_THAT(content(folder / "s/study.md"),
                AllOf(HasSubstr("(drag_contours.png)"), Not(HasSubstr("(never_curves.png)"))));
}

TEST_F(Study, SamplesTellWhatAQuantityDependsOn) {
    const std::string file = write(R"(scene: )" + press_yaml + R"(
axes:
  sample:
    sample: sobol
    runs: 8
    variables:
      mu: {key: contact.joint.friction, from: 0.1, to: 0.5}
      E: {key: bodies.cap.material.linear_elastic.E, from: 10 MPa, to: 40 MPa, spacing: logarithmic}
quantities:
  drag: {unit: N, history: pair.joint.friction}
  flat: {value: 7}
)");
    const Outcome outcome = study({file, "-o", "s", "--quiet"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    const std::string report = content(folder / "s/study.md");
    EXPECT_THAT(report, AllOf(HasSubstr("| sample | mu | E, MPa |"), HasSubstr("| flat | - | - | - | 8 |")));
    EXPECT_TRUE(std::regex_search(report, std::regex(R"(\| drag \| (1\.000|0\.999) \(1\.000\) \|)"))) << report;
    EXPECT_TRUE(fs::exists(folder / "s/drag_over_mu_curves.csv"));
}

TEST_F(Study, RunsAgainOnlyWhatChanged) {
    const std::string file = write(small_study);
    ASSERT_EQ(study({file, "-o", "s", "--quiet"}).code, 0);
    const std::string before = content(folder / "s/study.csv"), report = content(folder / "s/study.md");
    const auto seconds = seconds_of_runs(folder / "s/study.csv");

    ASSERT_EQ(study({file, "-o", "s"}).code, 0);
    EXPECT_EQ(content(folder / "s/study.csv"), before) << "nothing was run";
    EXPECT_EQ(content(folder / "s/study.md"), report);

    fs::remove(folder / "s/runs/friction=0.3,mesh=coarse/study_run.json");
    const Outcome one = study({file, "-o", "s"});
    EXPECT_THAT(one.err, AllOf(HasSubstr("run 1/1, friction=0.3,mesh=coarse"), Not(HasSubstr("friction=0.1"))));
    EXPECT_EQ(seconds_of_runs(folder / "s/study.csv").at("\"friction=0.1mesh=coarse\""),
              seconds.at("\"friction=0.1mesh=coarse\""));

    std::string changed = small_study; // another setting of one value
    changed.replace(changed.find("[4, 4, 2]"), 9, "[3, 3, 2]");
    const Outcome two = study({write(changed), "-o", "s"});
    EXPECT_THAT(two.err, AllOf(HasSubstr("run 2/2"), HasSubstr("mesh=fine"), Not(HasSubstr("mesh=coarse"))));
}

TEST_F(Study, MeasuresAnewWithoutRunning) {
    ASSERT_EQ(study({write(small_study), "-o", "s", "--quiet"}).code, 0);
    std::string changed = small_study;
    changed.replace(changed.find("sum(force_z)"), 12, "2 * sum(area)");
    const Outcome outcome = study({write(changed), "-o", "s", "--report-only"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");
    EXPECT_NEAR(table_of(folder / "s/study.csv").number(0, "weight.value"), 2, 1e-12); // m^2
}

TEST_F(Study, RunsOnlyWhatItIsToldTo) {
    const std::string file = write(small_study);
    const Outcome some = study({file, "-o", "s", "--only", "mesh=coarse"});
    EXPECT_EQ(some.code, 0) << some.err;
    EXPECT_THAT(some.err, AllOf(HasSubstr("run 2/2"), Not(HasSubstr("mesh=fine"))));
    EXPECT_EQ(table_of(folder / "s/study.csv").text(1, "status"), "waiting");
    const Outcome bad = study({file, "-o", "s", "--only", "mesh=corase", "--only", "msh=fine"});
    EXPECT_EQ(bad.code, 2);
    EXPECT_THAT(bad.err, AllOf(HasSubstr("did you mean 'coarse'?"), HasSubstr("did you mean 'mesh'?")));
}

TEST_F(Study, ListsItsFormulas) {
    EXPECT_THAT(study({"--formulas"}).out, HasSubstr("| `rod_reaction(t)` |"));
    EXPECT_EQ(study({}).code, 2);
}

TEST_F(Study, LosesNothingFinishedWhenItIsKilled) {
    std::string slow = small_study; // a tenth of a second a run and more
    slow.replace(slow.find("axes:"), 0, "set: {stages.pull.steps: 40}\n");
    const std::string file = write(slow);
    const pid_t child = start({"study", file, "-o", "s"});
    for (int i = 0; i < 600 && content(folder / "err.txt").find("run 2/4") == std::string::npos; ++i)
        std::this_thread::sleep_for(std::chrono::milliseconds(50));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    const Csv partial = table_of(folder / "s/study.csv"); // readable at any moment
    ASSERT_EQ(partial.rows.size(), 4U);
    std::vector<std::string> seconds;
    for (std::size_t i = 0; i < 4; ++i)
        if (partial.text(i, "status") == "done") seconds.push_back(partial.text(i, "wall_seconds"));
    ASSERT_GE(seconds.size(), 2U);
    const Outcome rest = study({file, "-o", "s"});
    ASSERT_EQ(rest.code, 0) << rest.err;
    EXPECT_THAT(rest.err, Not(HasSubstr("friction=0.1"))) << "the first two were finished";
    const Csv whole = table_of(folder / "s/study.csv");
    for (std::size_t i = 0; i < seconds.size(); ++i) EXPECT_EQ(whole.text(i, "wall_seconds"), seconds[i]);
}

TEST_F(Study, EndsItsRunsWhenItIsAskedToEnd) {
    std::string slow = small_study;
    slow.replace(slow.find("axes:"), 0, "set: {stages.pull.steps: 20000}\n");
    const pid_t child = start({"study", write(slow), "-o", "s", "--jobs", "2"});
    const fs::path run = folder / "s/runs/friction=0.1,mesh=fine/history.csv";
    for (int i = 0; i < 600 && !fs::exists(run); ++i) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    ASSERT_TRUE(fs::exists(run));
    kill(child, SIGTERM);
    int status = 0;
    waitpid(child, &status, 0);
    EXPECT_TRUE(WIFSIGNALED(status) && WTERMSIG(status) == SIGTERM);
    EXPECT_THAT(content(folder / "err.txt"), HasSubstr("stopped; the same command goes on from here"));
    const auto size = fs::file_size(run);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    EXPECT_EQ(fs::file_size(run), size) << "its run goes on";
}

TEST_F(Study, ARunThatGivesUpIsARow) {
    // pulled off the base, see Run.CountsEveryAttempt
    const Outcome outcome = study({write(R"(scene: )" + press_yaml + R"(
set: {solver.smallest_step: 0.3}
axes:
  far:
    no: {}
    yes: {set: {stages.pull.displacement.rear.x: 6 m}}
quantities:
  weight: {contact: joint, value: sum(force_z), reference: 1e5}
)"),
                                   "-o", "s"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("1 of 2 runs done, 1 gave up"));
    const Csv csv(folder / "s/study.csv");
    EXPECT_EQ(csv.text(0, "status"), "done");
    EXPECT_EQ(csv.text(1, "status"), "gave_up");
    EXPECT_EQ(csv.text(1, "weight.value"), "");
    EXPECT_THAT(content(folder / "s/study.csv"), HasSubstr("stage 'pull'"));
    EXPECT_THAT(content(folder / "s/study.md"), HasSubstr("gave up: stage 'pull'"));
    EXPECT_EQ(study({(folder / "small.yaml").string(), "-o", "s"}).err, "") << "it is finished, too";
}

TEST_F(Study, OfValuesAloneIsAMatrix) {
    fs::create_directories(folder / "scenes");
    std::ofstream(folder / "scenes/done.yaml") << content(press_yaml) << "expect: {outcome: completed}\n";
    std::ofstream(folder / "scenes/torn.yaml") << content(press_yaml) << "expect: {outcome: completed}\n"
                                               << "solver: {smallest_step: 0.3}\n";
    std::string torn = content(folder / "scenes/torn.yaml");
    torn.replace(torn.find("rear: {x: 0.1 m}"), 16, "rear: {x: 6 m}");
    std::ofstream(folder / "scenes/torn.yaml") << torn;
    const Outcome outcome = study({write(R"(problem: All of them.
axes:
  scene: {scenes: scenes/*.yaml}
quantities:
  steps: {value: steps}
  cuts: {value: rejected}
  iterations: {value: iterations, label: Newton iterations}
  balance: {value: force_balance}
  growth: {value: energy_growth}
  penetration: {value: penetration}
repeats: 2
)"),
                                   "-o", "s", "--quiet"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_THAT(outcome.out, HasSubstr("nothing to plot"));
    EXPECT_FALSE(fs::exists(folder / "s/study.gp"));
    const Csv csv(folder / "s/study.csv");
    ASSERT_EQ(csv.rows.size(), 2U);
    EXPECT_EQ(csv.text(0, "expectation"), "met");
    EXPECT_EQ(csv.text(1, "expectation"), "missed: gave up but should complete");
    EXPECT_EQ(csv.text(1, "status"), "gave_up");
    const Csv steps(folder / "s/runs/scene=torn/steps.csv");
    double iterations = 0;
    for (std::size_t i = 0; i < steps.rows.size(); ++i) iterations += steps.number(i, "iterations");
    EXPECT_EQ(csv.number(1, "iterations.value"), iterations) << "it gave up, and its work counts";
    EXPECT_GE(csv.number(1, "cuts.value"), 1);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_LT(csv.number(i, "balance.value"), 1e-9);
        // the audit has two triangles for a facet: where pulling warps these, closed nodes lie in them by some percent
        EXPECT_LT(csv.number(i, "penetration.value"), i == 0 ? 1e-9 : 0.1);
        EXPECT_EQ(csv.text(i, "growth.value"), "") << "a matter of dynamics";
        EXPECT_EQ(csv.text(i, "same_bits"), "yes") << "runs that gave up are repeated, too";
    }
    const std::string report = content(folder / "s/study.md");
    EXPECT_THAT(report, HasSubstr("2 runs: 1 completed, 1 gave up; 1 of 2 as expected; 0 not the same, bit for bit, "
                                  "when repeated."));
    EXPECT_THAT(report,
                HasSubstr("| scene | outcome | expectation | steps | cuts | Newton iterations | balance | growth | "
                          "penetration | CPU s | remark |"));
    EXPECT_THAT(report, HasSubstr("| done | completed | met | 4 | 0 | "));
    EXPECT_THAT(report, HasSubstr("| torn | gave up | missed: gave up but should complete | "));
    EXPECT_THAT(report, Not(HasSubstr("## Runs"))) << "one table says it all";
}

TEST_F(Study, RepeatsMustGiveTheSameBits) {
    const std::string file = write(small_study);
    ASSERT_EQ(study({file, "-o", "s", "--quiet", "--repeats", "2"}).code, 0);
    const Csv csv = table_of(folder / "s/study.csv");
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(csv.number(i, "repeats"), 2);
        EXPECT_EQ(csv.text(i, "same_bits"), "yes");
    }
    const Outcome third = study({file, "-o", "s", "--repeats", "3"});
    EXPECT_THAT(third.err, HasSubstr("run 4/4")) << "one more of each";
    std::ofstream(folder / "s/runs/friction=0.1,mesh=fine/history.csv", std::ios::app) << "\n";
    ASSERT_EQ(study({file, "-o", "s", "--quiet", "--repeats", "4"}).code, 0);
    EXPECT_EQ(table_of(folder / "s/study.csv").text(1, "same_bits"), "no");
    EXPECT_THAT(content(folder / "s/study.md"),
                HasSubstr("Repeats of friction=0.1,mesh=fine did not give the same bits"));
}

TEST_F(Study, FaultsOfItsScenesComeBeforeAnyRun) {
    std::string text = small_study;
    text.replace(text.find("[4, 4, 2]"), 9, "[4, 4, -2]");
    const Outcome bad = study({write(text), "-o", "s"});
    EXPECT_EQ(bad.code, 2);
    EXPECT_THAT(bad.err, HasSubstr("small.yaml:9:18: bodies.cap.mesh.block.divisions: expected"));
    // readable, but without a node where the set should be
    text = small_study;
    text.replace(text.find("{bodies.cap.mesh.block.divisions: [4, 4, 2]}"), 44,
                 "{sets.under: {body: cap, plane: {point: [0, 0, 9]}}}");
    const Outcome empty = study({write(text), "-o", "s"});
    EXPECT_EQ(empty.code, 2);
    EXPECT_THAT(empty.err, HasSubstr("small.yaml:9:"));
    EXPECT_FALSE(fs::exists(folder / "s/runs"));
}

TEST_F(Study, OfSurfacesIsTheSameCommand) {
    std::ofstream(folder / "surfaces.yaml") << R"(
surfaces: {ball: {shape: {sphere: {radius: 1}}}}
meshes: {refined: {coarsest: 4, levels: 2}}
methods: [facets, blend_1]
points: 1
)";
    const Outcome a = study({"surfaces.yaml", "-o", "a"});
    EXPECT_EQ(a.code, 0) << a.err;
    const Outcome b = osculate({"surface-study", "surfaces.yaml", "-o", "b"});
    EXPECT_EQ(b.code, 0) << b.err;
    const auto timeless = [](std::string table) { // without its last column, CPU seconds
        return std::regex_replace(table, std::regex(",[^,\n]*\n"), "\n");
    };
    ASSERT_THAT(content(folder / "a/study.csv"), HasSubstr(",cpu_seconds\n"));
    EXPECT_EQ(timeless(content(folder / "a/study.csv")), timeless(content(folder / "b/study.csv")));
    EXPECT_THAT(content(folder / "a/study.csv"), HasSubstr("blend_1"));
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
