#pragma once
/// Runs the cases of a study as processes of this program.

#include "app/study/study_case.hpp"

#include <functional>

namespace osculate::app {

struct StudyRunOptions {
    int jobs = 1, threads = 1, repeats = 1;
    std::vector<std::vector<std::size_t>> only; ///< by axis: values to run; empty stands for all
    bool quiet = false, force = false;          ///< force: see FolderOptions
};

/// Arguments of the program for a case.
[[nodiscard]] std::vector<std::string> run_words(const StudyCase& study_case, const std::string& scene_path,
                                                 const std::filesystem::path& folder, const StudyRunOptions& options);

/// Whether a case is among those to be run.
[[nodiscard]] bool is_chosen(const StudyCase& study_case, const StudyRunOptions& options);

/// Compiles the scene of every case that is still to be run, in processes of their own, so that no memory of theirs counts
/// for the runs.
/// @throws SceneError with all faults, each once
void check_cases(const scene::Study& study, const std::vector<StudyCase>& cases, const StudyRunOptions& options);

/// Runs what is not finished; `finished` is called after every run, whose record is on disk by then. Processes end with
/// this one, however it ends; SIGINT and SIGTERM end it after them.
void run_cases(std::vector<StudyCase>& cases, const StudyRunOptions& options, const std::function<void()>& finished);

} // namespace osculate::app
