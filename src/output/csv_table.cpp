#include "osculate/output/csv_table.hpp"

#include "osculate/core/error.hpp"
#include "output/files.hpp"

#include <cerrno>
#include <cmath>
#include <fmt/format.h>
#include <fstream>
#include <stdexcept>
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

/// Whether the first `bytes` of a file are rows below the line `head`.
void check_kept(const std::filesystem::path& path, const std::string& head, std::uintmax_t bytes) {
    std::error_code error;
    const std::uintmax_t size = std::filesystem::file_size(path, error);
    if (error) throw_unwritable(path, error);
    const auto fail = [&](const std::string& reason) {
        throw std::runtime_error("cannot go on with " + path.string() + ": " + reason);
    };
    if (size < bytes) fail(fmt::format("{} bytes are left of {}", size, bytes));
    std::ifstream file(path, std::ios::binary);
    std::string found(head.size(), ' ');
    file.read(found.data(), static_cast<std::streamsize>(found.size()));
    char last = 0;
    file.seekg(static_cast<std::streamoff>(bytes) - 1);
    if (!file || bytes < head.size() || found != head || !file.get(last) || last != '\n')
        fail("it is not the table the run has written");
}

} // namespace

Cell cell(double value) {
    if (std::isnan(value)) return std::string();
    return value;
}

CsvTable::CsvTable(std::filesystem::path path, const std::vector<std::string>& columns,
                   std::optional<std::uintmax_t> keep)
    : path_(std::move(path)), columns_(columns.size()) {
    const std::string head = joined({columns.begin(), columns.end()});
    make_folder_of(path_);
    if (keep) check_kept(path_, head, *keep);
    std::error_code error;
    if (keep) std::filesystem::resize_file(path_, *keep, error);
    if (error) throw_unwritable(path_, error);
    file_.reset(std::fopen(path_.c_str(), keep ? "ab" : "wb"));
    if (!file_) throw_unwritable(path_, {errno, std::generic_category()});
    // a row goes out in one piece: whoever kills the program leaves whole rows
    std::setvbuf(file_.get(), nullptr, _IOFBF, std::size_t{1} << 18);
    if (keep)
        size_ = *keep;
    else
        write(head);
}

void CsvTable::row(const std::vector<Cell>& cells) {
    require(cells.size() == columns_, "a row must have one cell per column of its table");
    write(joined(cells));
}

void CsvTable::sync() const {
    output::sync(path_);
}

void CsvTable::write(const std::string& line) {
    const bool written = std::fwrite(line.data(), 1, line.size(), file_.get()) == line.size();
    if (!written || std::fflush(file_.get()) != 0) throw_unwritable(path_, {errno, std::generic_category()});
    size_ += line.size();
}

} // namespace osculate::output
