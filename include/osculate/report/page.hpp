#pragma once
/// The report of a run: one HTML page that needs nothing beside it.

#include "osculate/report/moving_surfaces.hpp"
#include "osculate/time/attempt.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace osculate::report {

/// What is known beside the files of the run.
struct PageOptions {
    std::string version;                                        ///< of the program that writes the page
    std::vector<std::pair<std::string, std::string>> libraries; ///< name, version
    std::vector<time::Attempt> attempts;                        ///< of steps.csv
    std::string diary;                                          ///< the attempts' summary in words, lines
    std::vector<std::string> notes;                             ///< what is missing, sentences
    FrameBudget frames;
    std::size_t largest_view = 12'000'000; ///< bytes of the three-dimensional view in the page
};

struct Page {
    std::string html;
    std::vector<std::pair<std::string, std::string>> pictures; ///< file name and content, PNG and SVG
    std::vector<std::string> notes;                            ///< what the page leaves out and why, sentences
};

/// Makes the page of a run that has ended in whatever way, or still goes on. What is missing is named in the page.
/// @throws std::runtime_error with the path where summary.json is there and cannot be read
[[nodiscard]] Page make_page(const std::filesystem::path& run_folder, const PageOptions& options);

} // namespace osculate::report
