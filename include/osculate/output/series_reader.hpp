#pragma once
/// The list of a run's frames, read back.

#include "osculate/output/series.hpp"

#include <filesystem>
#include <vector>

namespace osculate::output {

/// Entries in the order of the file, which is that of time. @throws std::runtime_error with the path where it is no series
[[nodiscard]] std::vector<SeriesEntry> read_series(const std::filesystem::path& path);

} // namespace osculate::output
