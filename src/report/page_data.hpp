#pragma once
/// What the page's scripts read: one JSON, and arrays beside it, compressed and in base64.

#include "osculate/report/moving_surfaces.hpp"
#include "osculate/time/attempt.hpp"
#include "report/path_files.hpp"
#include "report/plot_files.hpp"
#include "report/run_files.hpp"

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace osculate::report {

/// Gathers JSON and arrays. Numbers that are not finite become null in the JSON, and names cannot end a script.
class PageData {
public:
    nlohmann::ordered_json json = nlohmann::ordered_json::object();

    /// @returns  the name by which the JSON may refer to the bytes
    std::string add(const Bytes& bytes);
    /// A table as columns of 32-bit floats; every n-th row where there are too many, which is noted.
    void add_table(const char* name, const output::NumberTable& table, std::vector<std::string>& notes);
    void add_attempts(const std::vector<time::Attempt>& attempts, std::vector<std::string>& notes);
    void add_plots(const std::vector<PlotFile>& plots);
    /// Every n-th time of a path where there are too many, which is noted.
    void add_paths(const std::vector<PathFile>& paths, std::vector<std::string>& notes);
    /// @param largest  bytes; frames are thinned out until the view takes no more
    void add_view(MovingSurfaces& surfaces, std::size_t largest, std::vector<std::string>& notes);

    /// Script elements that hold all of it.
    [[nodiscard]] std::string html() const;

private:
    [[nodiscard]] nlohmann::ordered_json view_of(const MovingSurfaces& surfaces);
    std::vector<std::string> arrays_; ///< base64
};

} // namespace osculate::report
