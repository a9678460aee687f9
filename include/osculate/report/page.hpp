#pragma once
/// The report of a run: one self-contained HTML page.

#include "osculate/report/moving_surfaces.hpp"
#include "osculate/time/attempt.hpp"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osculate::report {

/// Of a page that is served, not a file: it follows its run.
struct LiveOptions {
    std::string token; ///< with which it ends the run
    std::string stamp; ///< of the run's files as the page shows them
};

/// Data besides the files of the run.
struct PageOptions {
    std::string version;                                        ///< version of the program that writes the page
    std::vector<std::pair<std::string, std::string>> libraries; ///< name, version
    std::vector<time::Attempt> attempts;                        ///< of steps.csv
    std::string diary;                                          ///< summary of the attempts in words, lines
    std::vector<std::string> notes;                             ///< missing data, sentences
    FrameBudget frames;
    std::optional<LiveOptions> live{};
    std::size_t largest_view = 12'000'000; ///< largest size of the three-dimensional view in the page, bytes
};

struct Page {
    std::string html;
    std::vector<std::pair<std::string, std::string>> pictures; ///< file name and content, PNG and SVG
    std::vector<std::string> notes;                            ///< omissions of the page and their reasons, sentences
};

/// Makes the page of a run that has ended for any reason, or still continues. The page names missing data.
/// @throws std::runtime_error with the path if summary.json exists but cannot be read
[[nodiscard]] Page make_page(const std::filesystem::path& run_folder, const PageOptions& options);

} // namespace osculate::report
