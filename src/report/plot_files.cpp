#include "report/plot_files.hpp"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <fstream>
#include <limits>
#include <stdexcept>
#include <string_view>

namespace osculate::report {

namespace fs = std::filesystem;

namespace {

double number(std::string_view cell, int line) {
    double value = std::numeric_limits<double>::quiet_NaN();
    const char* end = cell.data() + cell.size();
    if (!cell.empty() && std::from_chars(cell.data(), end, value).ptr != end)
        throw std::runtime_error(fmt::format("line {}: '{}' is no number", line, cell));
    return value;
}

/// What stands between the quotes of a field that needed them.
std::string unquoted(std::string_view field) {
    if (field.size() < 2 || field.front() != '"' || field.back() != '"') return std::string(field);
    std::string text(field.substr(1, field.size() - 2));
    for (std::size_t at = text.find("\"\""); at != std::string::npos; at = text.find("\"\"", at + 1)) text.erase(at, 1);
    return text;
}

/// Rows of curve, x, y; those of one curve follow each other.
std::vector<PlotCurve> read_curves(const fs::path& path) {
    std::ifstream file(path, std::ios::binary);
    std::vector<PlotCurve> curves;
    std::string line;
    std::getline(file, line);
    if (line != "curve,x,y") throw std::runtime_error("its columns are not curve,x,y");
    for (int number_of_line = 2; std::getline(file, line); ++number_of_line) {
        const std::size_t last = line.rfind(','),
                          first = last == std::string::npos || last == 0 ? last : line.rfind(',', last - 1);
        if (first == std::string::npos || first == last)
            throw std::runtime_error(fmt::format("line {}: fewer than three columns", number_of_line));
        const std::string_view text = line;
        std::string name = unquoted(text.substr(0, first));
        if (curves.empty() || curves.back().name != name) curves.push_back({std::move(name), {}, {}});
        curves.back().x.push_back(number(text.substr(first + 1, last - first - 1), number_of_line));
        curves.back().y.push_back(number(text.substr(last + 1), number_of_line));
    }
    return curves;
}

} // namespace

std::vector<PlotFile> read_plot_files(const fs::path& folder, const scene::Scene& scene,
                                      std::vector<std::string>& notes) {
    std::vector<PlotFile> plots;
    for (const auto& [name, plot] : scene.output.plots) {
        const fs::path path = folder / "plots" / (name + ".csv");
        if (!fs::exists(path)) continue; // no column of the plot is in this scene's tables
        std::string title = plot.title.empty() ? name : plot.title;
        std::ranges::replace(title, '_', ' ');
        try {
            plots.push_back({title, plot.x_label.empty() ? plot.curves.front().second.x : plot.x_label, plot.y_label,
                             read_curves(path)});
        } catch (const std::runtime_error& error) {
            notes.push_back(fmt::format("plots/{}.csv cannot be read: {}.", name, error.what()));
        }
    }
    return plots;
}

} // namespace osculate::report
