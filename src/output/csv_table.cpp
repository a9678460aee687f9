#include "osculate/output/csv_table.hpp"

#include "osculate/core/error.hpp"
#include "output/files.hpp"

#include <cerrno>
#include <fmt/format.h>
#include <string_view>
#include <type_traits>
#include <utility>

namespace osculate::output {

namespace {

/// A field as RFC 4180 wants it: quoted when it holds what would end it early.
std::string field(std::string_view value) {
    const bool spaced = !value.empty() && (value.front() == ' ' || value.back() == ' ');
    if (!spaced && value.find_first_of(",\"\r\n") == std::string_view::npos) return std::string(value);
    std::string quoted = "\"";
    for (const char c : value) {
        if (c == '"') quoted += '"';
        quoted += c;
    }
    return quoted + '"';
}

std::string text(const Cell& cell) {
    return std::visit(
        [](const auto& value) -> std::string {
            if constexpr (std::is_same_v<std::decay_t<decltype(value)>, std::string>)
                return field(value);
            else
                return fmt::format("{}", value);
        },
        cell);
}

std::string joined(const std::vector<Cell>& values) {
    std::string line;
    for (const Cell& value : values) {
        if (&value != &values.front()) line += ',';
        line += text(value);
    }
    return line + '\n';
}

} // namespace

CsvTable::CsvTable(std::filesystem::path path, const std::vector<std::string>& columns)
    : path_(std::move(path)), columns_(columns.size()) {
    make_folder_of(path_);
    file_.reset(std::fopen(path_.c_str(), "wb"));
    if (!file_) throw_unwritable(path_, {errno, std::generic_category()});
    write(joined({columns.begin(), columns.end()}));
}

void CsvTable::row(const std::vector<Cell>& cells) {
    require(cells.size() == columns_, "a row must have one cell per column of its table");
    write(joined(cells));
}

void CsvTable::write(const std::string& line) {
    const bool written = std::fwrite(line.data(), 1, line.size(), file_.get()) == line.size();
    if (!written || std::fflush(file_.get()) != 0) throw_unwritable(path_, {errno, std::generic_category()});
}

} // namespace osculate::output
