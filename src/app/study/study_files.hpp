#pragma once
/// What a study writes.

#include "app/study/study_case.hpp"

namespace osculate::app {

/// study.csv, a row per run; whole at any moment.
void write_study_table(const scene::Study& study, const std::vector<StudyCase>& cases,
                       const std::filesystem::path& folder);

/// study.md.
void write_study_report(const scene::Study& study, const std::vector<StudyCase>& cases,
                        const std::filesystem::path& folder, const std::string& command);

/// study.gp and, with gnuplot, the plots; what there is to say about them.
std::string write_study_plots(const scene::Study& study, const std::vector<StudyCase>& cases,
                              const std::filesystem::path& folder);

} // namespace osculate::app
