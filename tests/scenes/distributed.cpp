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

TEST_F(DistributedRun, SpeaksWithOneVoice) {
    EXPECT_EQ(with_ranks(3, scene, "--set contact.base.frictoin=1"), 2);
    const std::string said = content(folder / "said.txt");
    const std::size_t first = said.find("did you mean 'friction'");
    ASSERT_NE(first, std::string::npos) << said;
    EXPECT_EQ(said.find("did you mean 'friction'", first + 1), std::string::npos) << said;
}

TEST_F(DistributedRun, NamesWhatProcessesCannotShare) {
    EXPECT_EQ(with_ranks(2, scene_file("configs/tutorials/bouncing_ball.yaml"), ""), 2);
    EXPECT_NE(content(folder / "said.txt").find("a dynamic stage"), std::string::npos) << content(folder / "said.txt");
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
