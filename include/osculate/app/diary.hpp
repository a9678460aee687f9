#pragma once
/// The diary of a run in words: what became of every attempted step, and what the rejected ones cost.

#include "osculate/time/attempt.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace osculate::app {

/// steps.csv of a run's folder as a table, and a summary by the reason of rejection: attempts, iterations lost, the
/// smallest step and when, the node that governed most often; then post_mortem.json, where the run gave up.
/// @throws SceneError for a missing file and for every damaged line, with what was expected
[[nodiscard]] std::string diary(const std::filesystem::path& folder);

/// steps.csv of a run that may still be writing it: a last line without its end is left out.
/// @throws SceneError as diary()
[[nodiscard]] std::vector<time::Attempt> attempts_so_far(const std::filesystem::path& folder);

/// The summary alone: totals, and the table by the reason of rejection.
[[nodiscard]] std::string summary_of(const std::vector<time::Attempt>& attempts);

} // namespace osculate::app
