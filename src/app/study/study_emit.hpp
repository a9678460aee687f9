#pragma once
/// Studies as files that other programs run: a Snakemake workflow, a SLURM array.

#include "app/study/study_runner.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace osculate::app {

/// Writes folder/Snakefile with a rule per chosen case, which ends with the table and the report. Folders of cases are made,
/// with the record that says what their results will follow from.
/// @param gather  words of the program that gather the results
/// @returns  what to do with it
/// @throws RunFailure where a file cannot be written
[[nodiscard]] std::string emit_snakemake(const scene::Study& study, const std::vector<StudyCase>& cases,
                                         const StudyRunOptions& options, const std::filesystem::path& folder,
                                         const std::vector<std::string>& gather);

/// Writes folder/study.sbatch, an array with a task per chosen case that is not finished, and folder/cases.txt with the
/// arguments of each. The rest as above.
[[nodiscard]] std::string emit_slurm(const scene::Study& study, const std::vector<StudyCase>& cases,
                                     const StudyRunOptions& options, const std::filesystem::path& folder,
                                     const std::vector<std::string>& gather);

} // namespace osculate::app
