/// Studies whose runs are tasks of a cluster: written for SLURM or Snakemake, and gathered.

#include "scenes/study.hpp"

#include <cstdlib>
#include <gmock/gmock.h>

namespace osculate::scenes::OSCULATE_THIS_FILE {
namespace {

using testing::AllOf;
using testing::HasSubstr;

class StudyOnClusters : public StudyProgram {};

/// Three runs that complete and one that gives up.
const std::string study_with_a_failure = [] {
    std::string text = small_study;
    const std::string fine = "{bodies.cap.mesh.block.divisions: [4, 4, 2]}";
    text.replace(text.find(fine), fine.size(),
                 "{bodies.cap.mesh.block.divisions: [4, 4, 2], solver.smallest_step: 0.3, "
                 "stages.pull.displacement.rear.x: 6 m}");
    return text;
}();

/// A table of a study without what no two runs have in common: seconds and memory.
std::vector<std::vector<std::string>> timeless(const fs::path& path) {
    const Csv csv = table_of(path);
    std::vector<std::vector<std::string>> rows{{}};
    const auto varies = [](const std::string& name) {
        return name.find("seconds") != std::string::npos || name.find("memory") != std::string::npos;
    };
    for (const auto& row : csv.rows) {
        rows.emplace_back();
        for (std::size_t i = 0; i < row.size() && i < csv.columns.size(); ++i)
            if (!varies(csv.columns[i])) rows.back().push_back(csv.columns[i] + "=" + row[i]);
    }
    return rows;
}

/// The tasks of a SLURM array one after another, `srun` being nothing but its arguments.
TEST_F(StudyOnClusters, RunBySlurmAndGatheredIsTheStudyRunHere) {
    const std::string file = write(study_with_a_failure);
    ASSERT_EQ(study({file, "-o", "here", "--quiet"}).code, 0);
    const Outcome emitted = study({file, "-o", "there", "--emit", "slurm"});
    ASSERT_EQ(emitted.code, 0) << emitted.err;
    EXPECT_THAT(emitted.out, AllOf(HasSubstr("4 runs; `sbatch there/study.sbatch`"), HasSubstr("--gather")));
    EXPECT_THAT(content(folder / "there/study.sbatch"), HasSubstr("#SBATCH --array=1-4\n"));
    EXPECT_FALSE(fs::exists(folder / "there/study.csv"));

    std::ofstream(folder / "srun") << "#!/bin/sh\nexec \"$@\"\n";
    fs::permissions(folder / "srun", fs::perms::owner_all);
    const auto task = [&](int number) {
        return std::system(("cd / && PATH=" + folder.string() + ":$PATH SLURM_ARRAY_TASK_ID=" + std::to_string(number) +
                            " bash " + (folder / "there/study.sbatch").string())
                               .c_str());
    };
    for (int number = 1; number <= 3; ++number) EXPECT_EQ(task(number), 0);
    ASSERT_EQ(study({file, "-o", "there", "--gather"}).code, 0);
    EXPECT_EQ(table_of(folder / "there/study.csv").text(3, "status"), "waiting");
    const Outcome rest = study({file, "-o", "there", "--emit", "slurm"});
    EXPECT_THAT(rest.out, HasSubstr("1 runs;")) << "what is finished is not done again";
    EXPECT_EQ(task(1), 0);
    EXPECT_NE(task(2), 0) << "there is no such task";

    const Outcome gathered = study({file, "-o", "there", "--gather"});
    EXPECT_THAT(gathered.out, HasSubstr("2 of 4 runs done, 2 gave up"));
    EXPECT_EQ(timeless(folder / "there/study.csv"), timeless(folder / "here/study.csv"));
    EXPECT_THAT(study({file, "-o", "there", "--emit", "slurm"}).out, HasSubstr("every run is finished"));
}

TEST_F(StudyOnClusters, RunBySnakemakeIsTheStudyRunHere) {
    if (std::system("snakemake --version > /dev/null 2>&1") != 0) GTEST_SKIP() << "no snakemake here";
    const std::string file = write(study_with_a_failure);
    ASSERT_EQ(study({file, "-o", "here", "--quiet"}).code, 0);
    ASSERT_EQ(study({file, "-o", "there", "--emit", "snakemake"}).code, 0);
    const std::string command = "cd " + folder.string() + " && HOME=" + folder.string() +
                                " snakemake -s there/Snakefile --cores 2 > log.txt 2>&1";
    ASSERT_EQ(std::system(command.c_str()), 0) << content(folder / "log.txt");
    EXPECT_EQ(timeless(folder / "there/study.csv"), timeless(folder / "here/study.csv"));
    ASSERT_EQ(std::system(command.c_str()), 0);
    EXPECT_THAT(content(folder / "log.txt"), HasSubstr("Nothing to be done"));
}

TEST_F(StudyOnClusters, HasNoSurfaces) {
    const Outcome refused = study({scene_file("configs/studies/table1.yaml"), "--emit", "slurm"});
    EXPECT_EQ(refused.code, 2);
    EXPECT_THAT(refused.err, HasSubstr("--emit: expected a study of runs"));
}

/// A task that ends badly without a summary leaves its exit code and its words.
TEST_F(StudyOnClusters, ATaskThatIsRefusedIsARow) {
    const std::string file = write(small_study);
    ASSERT_EQ(study({file, "-o", "s", "--emit", "slurm"}).code, 0);
    const fs::path run = folder / "s/runs/friction=0.1,mesh=coarse";
    std::ofstream(run / "exit_code") << "2\n";
    std::ofstream(run / "messages.txt") << "first\nno such file\n";
    ASSERT_EQ(study({file, "-o", "s", "--gather"}).code, 0);
    const Csv csv = table_of(folder / "s/study.csv");
    EXPECT_EQ(csv.text(0, "status"), "refused");
    EXPECT_EQ(csv.text(0, "reason"), "no such file");
    EXPECT_EQ(csv.text(1, "status"), "waiting");
}

} // namespace
} // namespace osculate::scenes::OSCULATE_THIS_FILE
