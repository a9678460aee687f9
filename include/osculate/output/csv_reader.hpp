#pragma once
/// Tables of numbers, read back.

#include <filesystem>
#include <string>
#include <vector>

namespace osculate::output {

struct NumberTable {
    std::vector<std::string> names;
    std::vector<std::vector<double>> columns; ///< an empty cell is NaN
};

/// Reads a table that contains only numbers, such as history.csv. Ignores a last line without line end.
/// @throws std::runtime_error with path and line if it contains anything else
[[nodiscard]] NumberTable read_numbers(const std::filesystem::path& path);

} // namespace osculate::output
