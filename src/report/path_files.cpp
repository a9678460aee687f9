#include "report/path_files.hpp"

#include "osculate/output/csv_reader.hpp"
#include "osculate/output/probe.hpp"
#include "osculate/output/probe_file.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>
#include <stdexcept>
#include <string_view>

namespace osculate::report {

namespace fs = std::filesystem;

namespace {

struct Path {
    std::size_t samples = 0; ///< 0: the probe lies along none
    bool angle = false;
};

Path path_of(const scene::Probe& probe) {
    return std::visit(
        [](const auto& kind) {
        if constexpr (requires { kind.samples; })
            return Path{static_cast<std::size_t>(kind.samples), requires {kind.angle; }
};
else return Path{};
},
        probe.kind);
}

/// "displacement_x [m]" -> "m"
std::string unit_of_column(const std::string& header) {
    const std::size_t open = header.find(" [");
    return open == std::string::npos ? "" : header.substr(open + 2, header.size() - open - 3);
}

const std::vector<double>& column(const output::NumberTable& table, std::string_view name) {
    for (std::size_t c = 0; c < table.names.size(); ++c)
        if (output::name_of_column(table.names[c]) == name) return table.columns[c];
    throw std::runtime_error(fmt::format("it has no column {}", name));
}

bool says_where(const std::string& name) {
    static constexpr std::array<std::string_view, 6> places{"time", "s", "angle", "X", "Y", "Z"};
    return std::ranges::find(places, name) != places.end();
}

PathFile read(const fs::path& file, const std::string& name, const Path& path) {
    const output::NumberTable table = output::read_numbers(file);
    const std::vector<double>&time = column(table, "time"), &at = column(table, path.angle ? "angle" : "s");
    const std::size_t n = path.samples;
    PathFile result;
    result.name = name;
    result.angle = path.angle;
    for (std::size_t first = 0; first + n <= time.size(); first += n) {
        for (std::size_t i = 0; i < n; ++i)
            if (time[first + i] != time[first] || at[first + i] != at[i])
                throw std::runtime_error("its rows are not the same places at every time");
        result.times.push_back(time[first]);
    }
    if (result.times.empty()) return result;
    result.at.assign(at.begin(), at.begin() + static_cast<std::ptrdiff_t>(n));
    for (std::size_t c = 0; c < table.names.size(); ++c) {
        const std::vector<double>& values = table.columns[c];
        PathField field{output::name_of_column(table.names[c]), unit_of_column(table.names[c]), {}};
        if (says_where(field.name) || std::ranges::none_of(values, [](double v) { return std::isfinite(v); })) continue;
        for (std::size_t f = 0; f < result.times.size(); ++f) {
            const auto first = values.begin() + static_cast<std::ptrdiff_t>(f * n);
            field.values.frames.emplace_back(first, first + static_cast<std::ptrdiff_t>(n));
        }
        result.fields.push_back(std::move(field));
    }
    return result;
}

} // namespace

std::vector<PathFile> read_path_files(const fs::path& folder, const scene::Scene& scene,
                                      std::vector<std::string>& notes) {
    std::vector<PathFile> paths;
    for (const auto& [name, probe] : scene.output.probes) {
        const Path path = path_of(probe);
        const fs::path file = output::ProbeFile::path(folder, name);
        if (path.samples == 0 || !fs::exists(file)) continue;
        try {
            PathFile one = read(file, name, path);
            if (!one.fields.empty()) paths.push_back(std::move(one));
        } catch (const std::runtime_error& error) {
            notes.push_back(fmt::format("probes/{}.csv cannot be read: {}.", name, error.what()));
        }
    }
    return paths;
}

} // namespace osculate::report
