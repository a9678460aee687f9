#pragma once
/// Tables a run writes row by row.

#include <cstdio>
#include <filesystem>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace osculate::output {

using Cell = std::variant<double, long, std::string>;

/// Comma-separated values (RFC 4180, lines end in \n) with one line of column names. Every row reaches the file before
/// row() returns; a double is written with the fewest digits that read back as the same number.
class CsvTable {
public:
    /// Starts the file anew; its folder is made when missing.
    /// @throws std::runtime_error with path and reason, as row() does
    CsvTable(std::filesystem::path path, const std::vector<std::string>& columns);

    /// @throws InternalError when there is not one cell per column
    void row(const std::vector<Cell>& cells);

private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    void write(const std::string& line);

    std::filesystem::path path_;
    std::size_t columns_;
    std::unique_ptr<std::FILE, Close> file_;
};

} // namespace osculate::output
