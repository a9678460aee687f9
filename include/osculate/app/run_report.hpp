#pragma once
/// The report of a run: one HTML file to pass on, and its pictures and plots as files.

#include "osculate/output/output_folder.hpp"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace osculate::app {

/// A report or a film cannot be written, although the folder is that of a run. what() is the whole message.
class ReportFailure : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

struct WrittenReport {
    std::filesystem::path page;     ///< report.html in the folder of the run
    std::vector<std::string> notes; ///< what the page leaves out and why, sentences
};

/// Writes report.html and the folder report/ (pictures; plots if gnuplot is installed) into the folder of a run,
/// whether it has completed, failed, was killed or continues. Replaces files of an earlier report, and no other files.
/// @throws SceneError if the folder is not that of a run
/// @throws ReportFailure with path and reason if a file cannot be read or written
[[nodiscard]] WrittenReport write_report(const std::filesystem::path& run_folder);

/// The same from within the run.
[[nodiscard]] WrittenReport write_report(output::OutputFolder& run);

} // namespace osculate::app
