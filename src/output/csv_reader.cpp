#include "osculate/output/csv_reader.hpp"

#include "osculate/core/file_content.hpp"

#include <charconv>
#include <limits>
#include <sstream>
#include <stdexcept>

namespace osculate::output {

namespace {

std::vector<std::string> split(const std::string& line) {
    std::vector<std::string> cells(1);
    for (const char c : line) {
        if (c == ',')
            cells.emplace_back();
        else
            cells.back() += c;
    }
    return cells;
}

} // namespace

NumberTable read_numbers(const std::filesystem::path& path) {
    std::error_code error;
    std::string text = file_content(path, error);
    if (error) throw std::runtime_error("cannot read " + path.string());
    text.resize(text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n') + 1);
    std::istringstream lines(text);
    std::string line;
    NumberTable table;
    for (int number = 1; std::getline(lines, line); ++number) {
        const std::vector<std::string> cells = split(line);
        if (number == 1) {
            table.names = cells;
            table.columns.resize(cells.size());
            continue;
        }
        const auto fail = [&] {
            throw std::runtime_error(path.string() + ":" + std::to_string(number) + ": expected " +
                                     std::to_string(table.names.size()) + " numbers");
        };
        if (cells.size() != table.names.size()) fail();
        for (std::size_t c = 0; c < cells.size(); ++c) {
            double value = std::numeric_limits<double>::quiet_NaN();
            const char* end = cells[c].data() + cells[c].size();
            if (!cells[c].empty() && std::from_chars(cells[c].data(), end, value).ptr != end) fail();
            table.columns[c].push_back(value);
        }
    }
    return table;
}

} // namespace osculate::output
