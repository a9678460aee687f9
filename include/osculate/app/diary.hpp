#pragma once
/// The diary of a run in words: the outcome of every attempted step, and the cost of rejected steps.

#include "osculate/time/attempt.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace osculate::app {

/// steps.csv of a run's folder as a table, and a summary by reason of rejection: attempts, lost iterations, the
/// smallest step and its time, the node that governed most often; then post_mortem.json, if the run failed.
/// @throws SceneError for a missing file and for every damaged line, with the expected content
[[nodiscard]] std::string diary(const std::filesystem::path& folder);

/// steps.csv of a run that may still be writing it: ignores a last line without line end.
/// @throws SceneError like diary()
[[nodiscard]] std::vector<time::Attempt> attempts_so_far(const std::filesystem::path& folder);

/// Only the summary: totals, and the table by reason of rejection.
[[nodiscard]] std::string summary_of(const std::vector<time::Attempt>& attempts);

} // namespace osculate::app
