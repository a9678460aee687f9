#pragma once
/// The diary of a run in words: what became of every attempted step, and what the rejected ones cost.

#include <filesystem>
#include <string>

namespace osculate::app {

/// steps.csv of a run's folder as a table, and a summary by the reason of rejection: attempts, iterations lost, the
/// smallest step and when, the node that governed most often; then post_mortem.json, where the run gave up.
/// @throws SceneError for a missing file and for every damaged line, with what was expected
[[nodiscard]] std::string diary(const std::filesystem::path& folder);

} // namespace osculate::app
