#pragma once
/// Tables that a run writes row by row.

#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <variant>
#include <vector>

namespace osculate::output {

using Cell = std::variant<double, long, std::string>;

/// The number, or an empty cell for NaN.
[[nodiscard]] Cell cell(double value);

/// Comma-separated values (RFC 4180, lines end in \n) with one line of column names. Every row reaches the file before
/// row() returns; a double is written with the fewest digits that read back as the same number.
class CsvTable {
public:
    /// Starts a new file; creates its folder if missing.
    /// @param keep  first bytes of the existing file to keep, whole rows below the same line of names; not given: none
    /// @throws std::runtime_error with path and reason, like row()
    CsvTable(std::filesystem::path path, const std::vector<std::string>& columns,
             std::optional<std::uintmax_t> keep = std::nullopt);

    /// @throws InternalError unless there is one cell per column
    void row(const std::vector<Cell>& cells);
    /// Waits until every row is on the disk.
    void sync() const;
    /// Bytes written so far, including those kept.
    [[nodiscard]] std::uintmax_t size() const { return size_; }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

private:
    struct Close {
        void operator()(std::FILE* file) const { std::fclose(file); }
    };
    void write(const std::string& line);

    std::filesystem::path path_;
    std::size_t columns_;
    std::uintmax_t size_ = 0;
    std::unique_ptr<std::FILE, Close> file_;
};

} // namespace osculate::output
