/// How shared runs are stopped, go on, fail and end.

#include "scenes/distributed_run.hpp"

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

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
        EXPECT_TRUE(fs::exists(folder / ("run/frames/lower_00002" + std::string(ranks == 1 ? ".vtu" : ".pvtu"))));
        EXPECT_EQ(output::read_frame(folder / "run/frames/lower_00001.pvtu").points.size(), 729U)
            << "of before, by two processes";
        const fs::directory_iterator begin(folder / "run/frames/pieces"), end;
        EXPECT_EQ(
            std::any_of(begin, end,
                        [](const auto& entry) { return entry.path().filename().string().starts_with("lower_00002_"); }),
            ranks > 1);
        EXPECT_EQ(fs::exists(folder / "run/frames/lower_00002.pvtu"), ranks > 1);
        if (ranks == 2) {
            EXPECT_EQ(content(folder / "run/history.csv"), content(folder / "whole/history.csv"));
        }
    }
}

/// The script's job is stopped before its time is over, queues again and goes on.
TEST_F(DistributedRun, IsAJobOfAClusterThatGoesOnWhereItWasStopped) {
    const std::vector<std::string> words{"run",       scene,
                                         "--set",     "solver.linear_solver=multigrid",
                                         "--set",     "bodies.lower.mesh.block.divisions=[8, 8, 8]",
                                         "--set",     "bodies.upper.mesh.block.divisions=[6, 6, 6]",
                                         "--set",     "stages.press.steps=30",
                                         "--threads", "1"};
    std::vector<std::string> emitting = words, whole = words;
    emitting.insert(emitting.end(), {"-o", "run", "--emit", "slurm", "--processes", "2"});
    whole.insert(whole.end(), {"-o", "whole", "--quiet"});
    const Outcome emitted = osculate(emitting);
    ASSERT_EQ(emitted.code, 0) << emitted.err;
    EXPECT_THAT(emitted.out, testing::HasSubstr("run.sbatch` runs it by 2 processes"));
    EXPECT_THAT(content(folder / "run.sbatch"), testing::HasSubstr("#SBATCH --ntasks=2\n"));
    EXPECT_FALSE(fs::exists(folder / "run"));
    fs::create_directory(folder / "bin");
    std::ofstream(folder / "bin/scontrol") << "#!/bin/sh\necho \"$@\" > scontrol.txt\n";
    fs::permissions(folder / "bin/scontrol", fs::perms::owner_all);
    const std::string job = for_mpi + "PATH=" + (folder / "bin").string() +
                            ":$PATH SLURM_JOB_ID=7 OSCULATE=" + OSCULATE_PROGRAM +
                            " MPIRUN='mpirun --oversubscribe --bind-to none -n 2' bash run.sbatch";
    std::ofstream(folder / "stopped.sh")
        << job << " > said.txt 2>&1 < /dev/null & job=$!\n"
        << "until [ \"$(cat run/history.csv 2>/dev/null | wc -l)\" -ge 3 ]; do sleep 0.05; done\n"
        << "kill -TERM $job\nwait $job\n";
    const auto shell = [&](const std::string& line) {
        return WEXITSTATUS(std::system(("cd " + folder.string() + " && " + line).c_str()));
    };
    EXPECT_EQ(shell("timeout 100 bash stopped.sh"), 143) << content(folder / "said.txt");
    EXPECT_EQ(content(folder / "scontrol.txt"), "requeue 7\n") << content(folder / "said.txt");
    EXPECT_LT(Csv(folder / "run/history.csv").rows.size(), 30U);
    ASSERT_EQ(shell(job + " > said.txt 2>&1 < /dev/null"), 0) << content(folder / "said.txt");
    ASSERT_EQ(osculate(whole).code, 0);
    EXPECT_EQ(Csv(folder / "run/history.csv").rows.size(), 30U);
    expect_the_same(folder / "run", folder / "whole", 1e-6);
}

TEST_F(DistributedRun, SpeaksWithOneVoice) {
    EXPECT_EQ(with_ranks(3, scene, "--set contact.base.frictoin=1"), 2);
    const std::string said = content(folder / "said.txt");
    const std::size_t first = said.find("did you mean 'friction'");
    ASSERT_NE(first, std::string::npos) << said;
    EXPECT_EQ(said.find("did you mean 'friction'", first + 1), std::string::npos) << said;
}

/// Equations between means of many nodes, and contact of faces with midside nodes: GMRES with multigrid is not tried.
TEST_F(DistributedRun, LeavesWhatOnlyFactorsSolveToTheFirst) {
    const std::string quadratic = "--set solver.tolerance=1e-10 "
                                  "--set 'bodies.lower.mesh.block={origin: [0 m, 0 m, -1 m], size: [1 m, 1 m, 1 m], "
                                  "divisions: [4, 4, 2], element: hex20}' "
                                  "--set 'bodies.upper.mesh.block={origin: [0.1 m, 0.1 m, 0 m], size: [0.8 m, 0.8 m, "
                                  "0.8 m], divisions: [3, 3, 2], element: tet10}' ";
    const std::pair<std::string, std::string> runs[] = {
        {scene_file("configs/tutorials/hinge.yaml"), "--set solver.tolerance=1e-10 "}, {scene, quadratic}};
    for (const auto& [file, options] : runs) {
        ASSERT_EQ(std::system(("cd " + folder.string() + " && " + OSCULATE_PROGRAM + " run " + file + " --quiet " +
                               options + "-o alone --force > said.txt 2>&1")
                                  .c_str()),
                  0)
            << content(folder / "said.txt");
        ASSERT_EQ(with_ranks(2, file, options + "-o run_2 --force"), 0) << content(folder / "said.txt");
        expect_the_same(folder / "alone", folder / "run_2", 1e-9);
    }
}

TEST_F(DistributedRun, GivesUpWithAPostMortemAndAllFrames) {
    EXPECT_EQ(with_ranks(2, scene, settings + " --set solver.max_iterations=1 -o run"), 3);
    EXPECT_NE(content(folder / "said.txt").find("post-mortem"), std::string::npos);
    EXPECT_TRUE(fs::exists(folder / "run/post_mortem.json"));
}

/// Every component of every node is held or driven, so that no grid has an unknown; both sides of the contact are held.
TEST_F(DistributedRun, NeedsNoUnknownsButContactForces) {
    EXPECT_EQ(with_ranks(2, scene_file("configs/extreme/driven_through_a_wall.yaml"), "-o run"), 3);
    EXPECT_THAT(content(folder / "said.txt"), testing::HasSubstr("cause       singular_tangent: "));
}

/// A folder of somebody else: all end at once, with the words of the first.
TEST_F(DistributedRun, EndsTogetherWhereTheFirstCannotEnterTheFolder) {
    fs::create_directories(folder / "run");
    std::ofstream(folder / "run/history.csv") << "mine\n";
    EXPECT_EQ(with_ranks(2, scene, settings + " -o run"), 2);
    const std::string said = content(folder / "said.txt");
    EXPECT_THAT(said, testing::HasSubstr("history.csv"));
    EXPECT_THAT(said, testing::Not(testing::HasSubstr("ends alone")));
    EXPECT_EQ(content(folder / "run/history.csv"), "mine\n");
}

TEST_F(DistributedRun, NamesAProcessThatHasNoRoom) {
    std::ofstream(folder / "poor.sh") << "[ \"$OMPI_COMM_WORLD_RANK\" = 1 ] && export TMPDIR=/nowhere\nexec "
                                      << OSCULATE_PROGRAM << " run " << scene << " --distributed --quiet -o run\n";
    EXPECT_EQ(mpirun(2, "bash poor.sh"), 3);
    const std::string said = content(folder / "said.txt");
    EXPECT_NE(said.find("process 1 of 2: "), std::string::npos) << said;
    EXPECT_NE(said.find("/nowhere"), std::string::npos) << said;
}

TEST_F(DistributedRun, EndsTogetherWhereTheFolderCannotBeMade) {
    EXPECT_EQ(with_ranks(2, scene, settings + " -o /proc/run"), 3);
    const std::string said = content(folder / "said.txt");
    EXPECT_THAT(said, testing::HasSubstr("/proc/run"));
    EXPECT_THAT(said, testing::Not(testing::HasSubstr("ends alone")));
}

/// The first has a disk of its own that is full.
TEST_F(DistributedRun, EndsWhereOneProcessFailsAlone) {
    std::ofstream(folder / "full.sh") << "trap '' XFSZ\n[ \"$OMPI_COMM_WORLD_RANK\" = 0 ] && ulimit -f 1\nexec "
                                      << OSCULATE_PROGRAM << " run " << scene << " --distributed --quiet -o run\n";
    EXPECT_EQ(mpirun(2, "bash full.sh"), 3);
    const std::string said = content(folder / "said.txt");
    EXPECT_NE(said.find("process 0 of 2 ends alone, with exit code 3"), std::string::npos) << said;
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
