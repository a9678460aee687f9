#pragma once
/// Tables a run writes row by row.

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

/// Comma-separated values (RFC 4180, lines end in \n) with one line of column names. Every row reaches the file before
/// row() returns; a double is written with the fewest digits that read back as the same number.
class CsvTable {
public:
    /// Starts the file anew; its folder is made when missing.
    /// @param keep  not given; or the first bytes of the file that stay, whole rows below the same line of names
    /// @throws std::runtime_error with path and reason, as row() does
    CsvTable(std::filesystem::path path, const std::vector<std::string>& columns,
             std::optional<std::uintmax_t> keep = std::nullopt);

    /// @throws InternalError when there is not one cell per column
    void row(const std::vector<Cell>& cells);
    /// Every row has reached the disk when it returns.
    void sync() const;
    /// Bytes written so far, those kept among them.
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
