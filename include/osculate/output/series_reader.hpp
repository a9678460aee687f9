#pragma once
/// The list of a run's frames, read back.

#include "osculate/output/series.hpp"

#include <filesystem>
#include <vector>

namespace osculate::output {

/// Entries in the order of the file, which is the order of time. @throws std::runtime_error with the path if it is no
/// series
[[nodiscard]] std::vector<SeriesEntry> read_series(const std::filesystem::path& path);

} // namespace osculate::output
