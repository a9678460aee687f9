#pragma once
/// The files of a run, read back as far as they are there.

#include "osculate/output/csv_reader.hpp"
#include "osculate/scene/scene.hpp"
#include "osculate/time/post_mortem.hpp"
#include "report/path_files.hpp"
#include "report/plot_files.hpp"

#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace osculate::report {

struct RunFiles {
    nlohmann::json summary = nlohmann::json::object(); ///< empty where there is none
    std::string ended;                                 ///< when summary.json was written last, UTC
    std::string scene_text;
    std::optional<scene::Scene> scene;
    std::optional<output::NumberTable> history, iterations;
    std::vector<PlotFile> plots;
    std::vector<PathFile> paths;
    std::optional<time::PostMortem> post_mortem;
    bool failed_iterate = false; ///< whether the last iterate of a run that gave up is there
    std::vector<std::string> notes;

    [[nodiscard]] std::string name() const;
    [[nodiscard]] std::string status() const { return text("status", "unknown"); }
    /// Members of the summary; the given value where it is missing or of another type.
    [[nodiscard]] std::string text(const char* member, const std::string& otherwise) const;
    [[nodiscard]] double number(const char* member) const;
};

/// @throws std::runtime_error with the path where summary.json is there and cannot be read
[[nodiscard]] RunFiles read_run_files(const std::filesystem::path& folder);

} // namespace osculate::report
