#pragma once
/// The list of a run's frames, read back.

#include <filesystem>
#include <string>
#include <vector>

namespace osculate::output {

/// A file of series.pvd.
struct SeriesEntry {
    double time = 0; ///< s
    std::string part;
    std::string file; ///< relative to the folder of series.pvd
};

/// Entries in the order of the file, which is that of time. @throws std::runtime_error with the path where it is no series
[[nodiscard]] std::vector<SeriesEntry> read_series(const std::filesystem::path& path);

} // namespace osculate::output
