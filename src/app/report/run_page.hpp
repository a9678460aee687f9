#pragma once
/// The page of a run, before it becomes a file or is served.

#include "osculate/report/page.hpp"

#include <filesystem>

namespace osculate::app {

/// @throws SceneError if the folder is not that of a run
void check_run_folder(const std::filesystem::path& folder);

/// The page that `osculate view` serves: it asks its server for what is new.
/// @throws std::runtime_error with the path of a file that cannot be read
[[nodiscard]] report::Page live_page(const std::filesystem::path& run_folder, const report::LiveOptions& live);

} // namespace osculate::app
