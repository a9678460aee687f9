/// Probes and plots of a run whose stresses are known, as a user sees them.

#include "scenes/program.hpp"

#include <csignal>
#include <cstdlib>
#include <gmock/gmock.h>
#include <sched.h>
#include <set>
#include <sys/mount.h>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

namespace fs = std::filesystem;
using testing::AllOf;
using testing::Each;
using testing::HasSubstr;
using testing::Not;

const std::string column = scene_file("tests/scenes/column.yaml");
constexpr double p = 20e3, E = 10e6; // Pa

std::vector<std::string> names_in(const fs::path& folder) {
    std::vector<std::string> names;
    if (fs::exists(folder))
        for (const auto& entry : fs::directory_iterator(folder)) names.push_back(entry.path().filename().string());
    std::ranges::sort(names);
    return names;
}

class Probes : public Program {};

TEST_F(Probes, OfAPressedColumnAreTheExactSolution) {
    const fs::path files = run(column) / "probes";
    const Csv point(files / "middle.csv");
    ASSERT_EQ(point.rows.size(), 4U) << "a row per accepted step";
    for (std::size_t i = 0; i < 4; ++i) {
        const double now = p * point.number(i, "time [s]"); // the stage takes a second
        EXPECT_NEAR(point.number(i, "displacement_z [m]"), -now * 1.6 / E, 1e-10 * p / E);
        EXPECT_NEAR(point.number(i, "stress_min [Pa]"), -now, 1e-9 * p);
    }
    const Csv line(files / "through.csv");
    ASSERT_EQ(line.rows.size(), 2U * 9) << "every second step";
    for (std::size_t i = 0; i < 9; ++i) {
        const std::size_t row = 9 + i;
        EXPECT_EQ(line.number(row, "time [s]"), 1);
        if (i <= 4)
            EXPECT_NEAR(line.number(row, "stress_zz [Pa]"), -p, 1e-9 * p) << line.text(row, "Z [m]");
        else
            EXPECT_EQ(line.text(row, "stress_zz [Pa]"), "") << "above the body";
    }
    const Csv interface(files / "interface.csv");
    ASSERT_EQ(interface.rows.size(), 4U * 5);
    for (std::size_t i = 15; i < 20; ++i) {
        EXPECT_NEAR(interface.number(i, "normal_stress [Pa]"), p, 1e-9 * p);
        EXPECT_NEAR(interface.number(i, "tangential_traction_x [Pa]"), 0, 1e-9 * p);
        EXPECT_NEAR(interface.number(i, "friction_use"), 0, 1e-8);
        EXPECT_GE(interface.number(i, "master_facet"), 0);
    }
    const Csv loaded(files / "loaded.csv");
    EXPECT_NEAR(loaded.number(3, "mean_displacement_z [m]"), -2 * p / E, 1e-10 * p / E);
    EXPECT_NEAR(loaded.number(3, "sum_displacement_z [m]"), -9 * 2 * p / E, 1e-9 * p / E);
    EXPECT_NEAR(loaded.number(3, "max_energy_density [J/m^3]"), p * p / (2 * E), 1e-9 * p * p / E);
    EXPECT_NEAR(Csv(files / "touching.csv").number(3, "sum_contact_force_z [N]"), p, 1e-9 * p);
    const Csv ring(files / "ring.csv"); // a full turn
    ASSERT_EQ(ring.rows.size(), 4U * 5);
    EXPECT_NEAR(ring.number(17, "angle [rad]"), std::numbers::pi, 1e-14);
    EXPECT_NEAR(ring.number(17, "X [m]"), 0.1, 1e-14);
    EXPECT_NEAR(ring.number(17, "normal_stress [Pa]"), p, 1e-9 * p);
    const Csv foot(files / "foot.csv"); // of the master
    EXPECT_NEAR(foot.number(3, "force_z [N]"), -p, 1e-9 * p);
    EXPECT_NEAR(foot.number(3, "moment_y [N m]"), 0.5 * p, 1e-9 * p);
    EXPECT_NEAR(foot.number(3, "centre_x [m]"), 0.5, 1e-9);
    EXPECT_NEAR(foot.number(3, "mean_pressure [Pa]"), p, 1e-9 * p);
    EXPECT_NEAR(foot.number(3, "max_pressure [Pa]"), p, 1e-9 * p);
}

TEST_F(Probes, OfABodyThatFliesFreeKnowItsMotionAndNoStrain) {
    const fs::path files = run(scene_file("tests/scenes/all_fields.yaml")) / "probes";
    for (const char* name : {"point", "line", "nodes", "slave_line", "slaves"}) {
        const Csv table(files / (std::string(name) + ".csv"));
        ASSERT_FALSE(table.rows.empty()) << name;
        for (const auto& row : table.rows)
            for (std::size_t c = 0; c < row.size(); ++c) {
                if (table.columns[c].find("contact_gap") != std::string::npos) continue; // no slave
                EXPECT_NE(row[c], "") << name << ": " << table.columns[c];
            }
    }
    const Csv point(files / "point.csv"), nodes(files / "nodes.csv"), slaves(files / "slaves.csv");
    for (std::size_t i = 0; i < 3; ++i) {
        const double t = point.number(i, "time [s]");
        EXPECT_NEAR(point.number(i, "displacement_z [m]"), -t, 1e-9);
        EXPECT_NEAR(point.number(i, "velocity_z [m/s]"), -1, 1e-9);
        EXPECT_NEAR(point.number(i, "acceleration_z [m/s^2]"), 0, 1e-6);
        EXPECT_NEAR(point.number(i, "strain_zz"), 0, 1e-9);
        EXPECT_NEAR(nodes.number(i, "max_velocity_x [m/s]"), 0, 1e-9);
        EXPECT_NEAR(slaves.number(i, "min_gap [m]"), 0.1 - t, 1e-9);
        EXPECT_EQ(slaves.number(i, "max_status"), 0) << "open";
        EXPECT_EQ(slaves.number(i, "max_slip_rate_x [m/s]"), 0);
        EXPECT_GE(slaves.number(i, "min_master_facet"), 0);
        EXPECT_EQ(slaves.number(i, "min_normal_z"), 1);
    }
}

TEST_F(Probes, SectionForceIsTheLoadToTenDigits) {
    const Csv cut(run(column) / "probes" / "cut.csv");
    for (std::size_t i = 0; i < 4; ++i) {
        const double now = p * cut.number(i, "time [s]"); // on 1 m^2
        EXPECT_NEAR(cut.number(i, "force_z [N]"), -now, 1e-10 * p) << "compression";
        for (const char* none : {"force_x [N]", "force_y [N]", "moment_x [N m]", "moment_y [N m]", "moment_z [N m]"})
            EXPECT_NEAR(cut.number(i, none), 0, 1e-10 * p) << none;
    }
}

TEST_F(Probes, PlotsAreDrawnFromTheRunsTables) {
    const fs::path files = run(column) / "plots";
    const Csv forces(files / "forces.csv");
    ASSERT_EQ(forces.rows.size(), 8U) << "two curves of four steps";
    EXPECT_EQ(forces.text(0, "curve"), "section");
    EXPECT_NEAR(forces.number(3, "y"), p, 1e-9 * p);
    EXPECT_EQ(forces.text(4, "curve"), "contact") << "the one pair needs no name";
    EXPECT_NEAR(forces.number(7, "y"), p, 1e-9 * p);
    EXPECT_EQ(Csv(files / "profile.csv").rows.size(), 4U) << "places below 0.9 m, of the last time alone";
    EXPECT_THAT(content(files / "forces.gp"), HasSubstr("set title \"the section\\047s force\""));
}

TEST_F(Probes, PlotsOfAQuietRunSayNothing) {
    if (std::system("command -v gnuplot >/dev/null") != 0) GTEST_SKIP() << "gnuplot is not installed";
    const Outcome outcome = osculate(
        {"run", column, "-o", "run", "--quiet", "--set", "output.plots={level: {curves: {level: {y: time * 0 + 2}}}}"});
    EXPECT_EQ(outcome.err, "") << "gnuplot has something to say of curves that are level";
    EXPECT_TRUE(fs::exists(folder / "run" / "plots" / "level.csv"));
}

TEST_F(Probes, WithoutGnuplotTheScriptIsThereAndTheRunIsDone) {
    const Outcome outcome = osculate({"run", column, "-o", "run", "--quiet"}, [] { setenv("PATH", "/nowhere", 1); });
    EXPECT_EQ(outcome.code, 0);
    EXPECT_THAT(outcome.err, HasSubstr("no plots: gnuplot is not installed"));
    EXPECT_THAT(names_in(folder / "run" / "plots"),
                testing::ElementsAre("forces.csv", "forces.gp", "profile.csv", "profile.gp"));
}

TEST_F(Probes, ArePlottedWhereTheRunGivesUp) {
    const Outcome outcome = osculate(
        {"run", column, "-o", "run", "--quiet", "--set", "stages.torn_off={pressure: {top: -10 kPa}, steps: 2}"});
    EXPECT_EQ(outcome.code, 3) << "nothing holds the upper column then";
    const fs::path files = folder / "run";
    EXPECT_TRUE(fs::exists(files / "post_mortem.json"));
    const std::size_t steps = Csv(files / "history.csv").rows.size();
    EXPECT_GE(steps, 4U);
    EXPECT_EQ(Csv(files / "plots" / "forces.csv").rows.size(), 2 * steps);
}

TEST_F(Probes, NothingIsLeftOfThoseOfBefore) {
    const fs::path files = run(column);
    std::ofstream(files / "plots" / "notes.txt") << "mine";
    run(column, {"output.probes={}", "output.plots={}"});
    EXPECT_FALSE(fs::exists(files / "probes"));
    EXPECT_THAT(names_in(files / "plots"), testing::ElementsAre("notes.txt"));
}

TEST_F(Probes, MinimalWritesNoneAndComputesNone) {
    const std::string plain = scene_file("tests/scenes/press.yaml");
    const fs::path files = run(plain, {"output.template=minimal"});
    EXPECT_THAT(names_in(files), Each(Not(testing::AnyOf("probes", "plots", "show_in_paraview.py", "report.html"))));
    const std::string plan = osculate({"explain", plain, "--set", "output.template=minimal"}).out;
    const std::string left_out = plan.substr(std::min(plan.size(), plan.find("left out")));
    for (const char* part : {"nodal stresses", "nodal reactions", "probes", "plots", "field strain", "report"})
        EXPECT_THAT(left_out, HasSubstr(part));
}

TEST_F(Probes, PlacesAndFormulasThatAreNoneAreNamedBeforeTheRun) {
    const Outcome outside = osculate({"check", column, "--set", "output.probes.middle.point.at=[0.3 m, 0.4 m, 3 m]",
                                      "--set", "output.probes.cut.section_force.point=[0, 0, 5 m]"});
    EXPECT_EQ(outside.code, 2);
    EXPECT_THAT(outside.err, AllOf(HasSubstr("a point of body 'upper'"), HasSubstr("1 m from"), HasSubstr("a plane")));
    const Outcome formula = osculate({"check", column, "--set", "output.plots.forces.curves.section.y=-force_y2",
                                      "--set", "output.plots.profile.curves.stress.rows=thorough"});
    EXPECT_EQ(formula.code, 2);
    EXPECT_THAT(formula.err, AllOf(HasSubstr("output.plots.forces.curves.section.y"), HasSubstr("'force_y'"),
                                   HasSubstr("did you mean 'through'")));
}

TEST_F(Probes, ADiskThatIsFullIsNamedAndTheSeriesStaysReadable) {
    const fs::path disk = folder / "disk";
    fs::create_directories(disk);
    const auto small_disk = [&] { // of this process alone
        if (unshare(CLONE_NEWNS) != 0 || mount("none", "/", nullptr, MS_REC | MS_PRIVATE, nullptr) != 0 ||
            mount("tmpfs", disk.c_str(), "tmpfs", 0, "size=256k") != 0)
            std::exit(77);
    };
    const auto run_and_look = [&] {
        small_disk();
        const pid_t child = fork();
        if (child == 0) return; // runs the program
        int status = 0;
        waitpid(child, &status, 0);
        fs::copy(disk, folder / "left", fs::copy_options::recursive);
        std::exit(WIFEXITED(status) ? WEXITSTATUS(status) : 1);
    };
    const Outcome full = osculate({"run", column, "-o", disk.string(), "--quiet", "--set", "output.frame_every=1",
                                   "--set", "output.template=everything", "--set", "stages.press.steps=50"},
                                  run_and_look);
    if (full.code == 77) GTEST_SKIP() << "no file system may be mounted here";
    EXPECT_EQ(full.code, 3);
    EXPECT_THAT(full.err, AllOf(HasSubstr("cannot write " + disk.string()), HasSubstr("No space left on device")));
    const std::string series = content(folder / "left" / "series.pvd");
    EXPECT_THAT(series, HasSubstr("</VTKFile>"));
    std::set<std::string> listed;
    for (std::size_t at = series.find("file=\""); at != std::string::npos; at = series.find("file=\"", at + 1)) {
        const std::string file = series.substr(at + 6, series.find('"', at + 6) - at - 6);
        EXPECT_THAT(content(folder / "left" / file), testing::EndsWith("</VTKFile>\n")) << file;
        listed.insert(file);
    }
    EXPECT_GT(listed.size(), 3U) << "what was written before";
    for (const std::string& name : names_in(folder / "left" / "frames"))
        EXPECT_THAT(name, Not(HasSubstr(".part"))) << "halves are taken away";
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
