#pragma once
/// Runs shared by several processes, started as users start them.

#include "osculate/output/frame_reader.hpp"
#include "scenes/program.hpp"

#include <cmath>
#include <gmock/gmock.h>
#include <nlohmann/json.hpp>

namespace osculate::scenes {

namespace fs = std::filesystem;

/// Two blocks with friction, whose meshes do not match; the smooth master asks for nodes that no element joins to a slave.
class DistributedRun : public Program {
protected:
    /// Starts a command of the shell as several processes. @returns  exit code
    [[nodiscard]] int mpirun(int ranks, const std::string& command) const {
        return WEXITSTATUS(
            std::system(("cd " + folder.string() + " && " + for_mpi + "mpirun --oversubscribe --bind-to none -n " +
                         std::to_string(ranks) + " " + command + " > said.txt 2>&1 < /dev/null")
                            .c_str()));
    }
    [[nodiscard]] int with_ranks(int ranks, const std::string& file, const std::string& options) const {
        return mpirun(ranks,
                      std::string(OSCULATE_PROGRAM) + " run " + file + " --distributed --quiet --threads 1 " + options);
    }
    void expect_the_same(const fs::path& a, const fs::path& b, double tolerance, double more_iterations = 2) const {
        const Csv first(a / "history.csv"), second(b / "history.csv");
        ASSERT_EQ(first.columns, second.columns);
        ASSERT_EQ(first.rows.size(), second.rows.size());
        const auto each = [&](auto&& visit) {
            for (const std::string& column : first.columns)
                for (std::size_t row = 0; row < first.rows.size(); ++row)
                    if (!first.text(row, column).empty()) visit(row, column); // not in this stage
        };
        for (const std::string& column : first.columns)
            for (std::size_t row = 0; row < first.rows.size(); ++row)
                EXPECT_EQ(first.text(row, column).empty(), second.text(row, column).empty()) << column;
        double largest = 0; // a force
        each([&](std::size_t row, const std::string& column) {
            largest = std::max(largest, std::abs(first.number(row, column)));
        });
        each([&](std::size_t row, const std::string& column) {
            const double allowed =
                column == "iterations" ? more_iterations : tolerance * largest; // tests at the last digit
            EXPECT_NEAR(first.number(row, column), second.number(row, column), allowed) << column;
        });
    }

    /// A frame of one process and the pieces of several.
    void expect_the_same_frames(const std::string& name, const std::vector<std::string>& fields, const fs::path& one,
                                const fs::path& several, double tolerance) const {
        const output::Frame whole = output::read_frame(one / "frames" / (name + ".vtu")),
                            pieces = output::read_frame(several / "frames" / (name + ".pvtu"));
        ASSERT_EQ(pieces.points, whole.points);
        for (const std::string& field : fields) {
            const std::vector<double>&a = whole.find(field)->values, &b = pieces.find(field)->values;
            ASSERT_EQ(a.size(), b.size());
            double largest = 0, apart = 0;
            for (std::size_t i = 0; i < a.size(); ++i) {
                largest = std::max(largest, std::abs(a[i]));
                apart = std::max(apart, std::abs(a[i] - b[i]));
            }
            EXPECT_GT(largest, 0) << field;
            EXPECT_LT(apart, tolerance * largest) << field;
        }
    }

    // root, few processors and containers are no obstacles; processes that wait leave the processor to others
    const std::string for_mpi = "OMPI_ALLOW_RUN_AS_ROOT=1 OMPI_ALLOW_RUN_AS_ROOT_CONFIRM=1 "
                                "OMPI_MCA_btl_vader_single_copy_mechanism=none OMPI_MCA_mpi_yield_when_idle=1 ";
    const std::string scene = scene_file("bench/scenes/two_blocks.yaml");
    const std::string settings = "--set solver.linear_solver=multigrid --set solver.tolerance=1e-10 "
                                 "--set 'bodies.lower.mesh.block.divisions=[8, 8, 8]' "
                                 "--set 'bodies.upper.mesh.block.divisions=[6, 6, 6]' --set stages.press.steps=2";
};

} // namespace osculate::scenes
