/// One run shared by several processes, started as users start them.

#include "scenes/program.hpp"

#include <cmath>

namespace osculate::scenes {
namespace {

namespace fs = std::filesystem;

/// Two blocks with friction, whose meshes do not match; the smooth master asks for nodes that no element joins to a slave.
class DistributedRun : public Program {
protected:
    /// Starts a command of the shell as several processes. @returns  exit code
    [[nodiscard]] int mpirun(int ranks, const std::string& command) const {
        // root, few processors and containers are no obstacles
        const std::string for_mpi = "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
                                    "OMPI_MCA_btl_vader_single_copy_mechanism=none ";
        return WEXITSTATUS(
            std::system(("cd " + folder.string() + " && " + for_mpi + "mpirun --oversubscribe --bind-to none -n " +
                         std::to_string(ranks) + " " + command + " > said.txt 2>&1 < /dev/null")
                            .c_str()));
    }
    [[nodiscard]] int with_ranks(int ranks, const std::string& file, const std::string& options) const {
        return mpirun(ranks,
                      std::string(OSCULATE_PROGRAM) + " run " + file + " --distributed --quiet --threads 1 " + options);
    }
    void expect_the_same(const fs::path& a, const fs::path& b, double tolerance) const {
        const Csv first(a / "history.csv"), second(b / "history.csv");
        ASSERT_EQ(first.columns, second.columns);
        ASSERT_EQ(first.rows.size(), second.rows.size());
        double largest = 0; // a force
        for (const std::string& column : first.columns)
            for (std::size_t row = 0; row < first.rows.size(); ++row)
                largest = std::max(largest, std::abs(first.number(row, column)));
        for (const std::string& column : first.columns)
            for (std::size_t row = 0; row < first.rows.size(); ++row)
                EXPECT_NEAR(first.number(row, column), second.number(row, column), tolerance * largest) << column;
    }

    const std::string scene = scene_file("bench/scenes/two_blocks.yaml");
    const std::string settings = "--set solver.linear_solver=multigrid --set solver.tolerance=1e-10 "
                                 "--set 'bodies.lower.mesh.block.divisions=[8, 8, 8]' "
                                 "--set 'bodies.upper.mesh.block.divisions=[6, 6, 6]' --set stages.press.steps=2";
};

TEST_F(DistributedRun, GivesTheSameResultsWithAnyNumberOfProcesses) {
    for (const int ranks : {1, 2, 3, 4})
        ASSERT_EQ(with_ranks(ranks, scene, settings + " -o run_" + std::to_string(ranks)), 0)
            << content(folder / "said.txt");
    for (const int ranks : {2, 3, 4})
        expect_the_same(folder / "run_1", folder / ("run_" + std::to_string(ranks)), 1e-9);
}

TEST_F(DistributedRun, GivesTheSameBitsAgain) {
    for (const char* name : {"first", "second"})
        ASSERT_EQ(with_ranks(3, scene, settings + " -o " + name), 0) << content(folder / "said.txt");
    EXPECT_EQ(content(folder / "first/history.csv"), content(folder / "second/history.csv"));
}

/// Matrices that follow the displacements, whose values come from elements at own nodes.
TEST_F(DistributedRun, SharesFiniteStrain) {
    const std::string material = "'{neo_hookean: {E: 100 MPa, nu: 0.3}}'";
    const std::string options =
        settings + " --set bodies.lower.material=" + material + " --set bodies.upper.material=" + material;
    for (const int ranks : {1, 3})
        ASSERT_EQ(with_ranks(ranks, scene, options + " -o run_" + std::to_string(ranks)), 0)
            << content(folder / "said.txt");
    expect_the_same(folder / "run_1", folder / "run_3", 1e-9);
}

/// With a plastic one, whose histories all processes keep.
TEST_F(DistributedRun, SharesPlasticity) {
    const std::string plastic = "'{elastic_plastic: {E: 100 MPa, nu: 0.3, yield_stress: 1 MPa}}'";
    for (const int ranks : {1, 3})
        ASSERT_EQ(with_ranks(ranks, scene,
                             settings + " --set bodies.upper.material=" + plastic + " -o run_" + std::to_string(ranks)),
                  0)
            << content(folder / "said.txt");
    expect_the_same(folder / "run_1", folder / "run_3", 1e-9);
}

TEST_F(DistributedRun, SharesDynamics) {
    const std::string material = "'{linear_elastic: {E: 100 MPa, nu: 0.3, density: 1000 kg/m^3}}'";
    const std::string options = settings + " --set bodies.lower.material=" + material +
                                " --set bodies.upper.material=" + material +
                                " --set 'stages.press={analysis: dynamic, duration: 40 ms, steps: 4, displacement: "
                                "{top: {x: 0.2 mm, z: -1 mm}}}'";
    for (const int ranks : {1, 3})
        ASSERT_EQ(with_ranks(ranks, scene, options + " -o run_" + std::to_string(ranks)), 0)
            << content(folder / "said.txt");
    expect_the_same(folder / "run_1", folder / "run_3", 1e-9);
}

TEST_F(DistributedRun, SharesGeneralContact) {
    for (const int ranks : {1, 3})
        ASSERT_EQ(with_ranks(ranks, scene,
                             settings + " --set 'contact={general: {friction: 0.3}}' -o run_" + std::to_string(ranks)),
                  0)
            << content(folder / "said.txt");
    expect_the_same(folder / "run_1", folder / "run_3", 1e-9);
}

TEST_F(DistributedRun, GoesOnFromACheckpointWithAnotherNumberOfProcesses) {
    ASSERT_EQ(with_ranks(2, scene, settings + " --checkpoint-every 1 -o run"), 0) << content(folder / "said.txt");
    fs::copy(folder / "run", folder / "whole", fs::copy_options::recursive);
    fs::copy_file(folder / "run/checkpoint/state.previous", folder / "kept"); // of the first of two steps
    for (const int ranks : {1, 2, 3}) {
        ASSERT_EQ(
            mpirun(ranks, std::string(OSCULATE_PROGRAM) + " resume run --from kept --distributed --quiet --threads 1"),
            0)
            << content(folder / "said.txt");
        expect_the_same(folder / "run", folder / "whole", 1e-9);
        EXPECT_TRUE(fs::exists(folder / "run/frames/lower_00002.vtu"));
        if (ranks == 2) {
            EXPECT_EQ(content(folder / "run/history.csv"), content(folder / "whole/history.csv"));
        }
    }
}

TEST_F(DistributedRun, SpeaksWithOneVoice) {
    EXPECT_EQ(with_ranks(3, scene, "--set contact.base.frictoin=1"), 2);
    const std::string said = content(folder / "said.txt");
    const std::size_t first = said.find("did you mean 'friction'");
    ASSERT_NE(first, std::string::npos) << said;
    EXPECT_EQ(said.find("did you mean 'friction'", first + 1), std::string::npos) << said;
}

TEST_F(DistributedRun, NamesWhatProcessesCannotShare) {
    EXPECT_EQ(with_ranks(2, scene_file("configs/tutorials/bolted_joint.yaml"), ""), 2);
    EXPECT_NE(content(folder / "said.txt").find("rigid bodies, couplings, ties"), std::string::npos)
        << content(folder / "said.txt");
}

TEST_F(DistributedRun, GivesUpWithAPostMortemAndAllFrames) {
    EXPECT_EQ(with_ranks(2, scene, settings + " --set solver.max_iterations=1 -o run"), 3);
    EXPECT_NE(content(folder / "said.txt").find("post-mortem"), std::string::npos);
    EXPECT_TRUE(fs::exists(folder / "run/post_mortem.json"));
}

TEST_F(DistributedRun, NamesAProcessThatHasNoRoom) {
    std::ofstream(folder / "poor.sh") << "[ \"$OMPI_COMM_WORLD_RANK\" = 1 ] && export TMPDIR=/nowhere\nexec "
                                      << OSCULATE_PROGRAM << " run " << scene << " --distributed --quiet -o run\n";
    EXPECT_EQ(mpirun(2, "bash poor.sh"), 3);
    const std::string said = content(folder / "said.txt");
    EXPECT_NE(said.find("process 1 of 2: "), std::string::npos) << said;
    EXPECT_NE(said.find("/nowhere"), std::string::npos) << said;
}

TEST_F(DistributedRun, EndsWhereOneProcessFailsAlone) {
    EXPECT_EQ(with_ranks(2, scene, "-o /proc/run"), 3);
    const std::string said = content(folder / "said.txt");
    EXPECT_NE(said.find("process 0 of 2 ends alone, with exit code 3"), std::string::npos) << said;
}

} // namespace
} // namespace osculate::scenes
