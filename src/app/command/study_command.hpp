#pragma once
/// The command `osculate study`.

#include "osculate/app/run.hpp"
#include "osculate/scene/reader.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace osculate::app {

struct StudyOptions {
    std::filesystem::path directory; ///< out/<study name> when empty
    std::vector<scene::Override> overrides;
    int jobs = 1;
    int threads = 0;               ///< of every run; 0: one
    int repeats = 0;               ///< 0: those of the study
    std::vector<std::string> only; ///< "axis=value,value": runs nothing else
    bool report_only = false, quiet = false;
    FolderOptions folder{};
    std::string emit; ///< "snakemake" or "slurm": writes files that run it elsewhere, and runs nothing
};

/// Runs what of a study is not yet run and writes its tables, plots and report.
/// @returns what there is to say in the end
/// @throws SceneError with all faults of the study and its scenes before anything is run; InternalError when a run met a
///         bug, after everything else is done
[[nodiscard]] std::string run_study(const std::string& path, const StudyOptions& options);

/// The formulas that studies may call, as a table in Markdown.
[[nodiscard]] std::string formula_table();

} // namespace osculate::app
