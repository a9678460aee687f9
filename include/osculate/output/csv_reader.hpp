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

/// Reads a table that holds nothing but numbers, such as history.csv. A last line without its end is left out.
/// @throws std::runtime_error with path and line where it does not
[[nodiscard]] NumberTable read_numbers(const std::filesystem::path& path);

} // namespace osculate::output
