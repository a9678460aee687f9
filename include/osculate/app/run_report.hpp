#pragma once
/// The report of a run: one HTML file for a colleague, and its pictures and plots as files.

#include "osculate/output/output_folder.hpp"

#include <filesystem>
#include <stdexcept>
#include <string>
#include <vector>

namespace osculate::app {

/// A report that cannot be written, though the folder is that of a run.
class ReportFailure : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

struct WrittenReport {
    std::filesystem::path page;     ///< report.html in the folder of the run
    std::vector<std::string> notes; ///< what the page leaves out and why, sentences
};

/// Writes report.html and the folder report/ (pictures; plots where gnuplot is installed) into the folder of a run, be it
/// done, given up, killed or still going on. Files of an earlier report are replaced, no other file is touched.
/// @throws SceneError where the folder is none of a run
/// @throws ReportFailure with path and reason where a file cannot be read or written
[[nodiscard]] WrittenReport write_report(const std::filesystem::path& run_folder);

/// The same from within the run.
[[nodiscard]] WrittenReport write_report(output::OutputFolder& run);

} // namespace osculate::app
