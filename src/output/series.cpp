#include "osculate/output/series.hpp"

#include "osculate/core/escaped.hpp"
#include "output/files.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <string_view>
#include <utility>

namespace osculate::output {

Series::Series(std::filesystem::path directory, std::vector<SeriesEntry> earlier)
    : path_(std::move(directory) / "series.pvd"), entries_(std::move(earlier)) {
    flush();
}

void Series::add(double time, const std::string& part_name, const std::string& relative_file) {
    entries_.push_back({time, part_name, relative_file});
}

void Series::flush() {
    fmt::memory_buffer text;
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n  <Collection>\n");
    std::vector<std::string_view> parts;
    for (const SeriesEntry& entry : entries_) {
        const auto place = std::ranges::find(parts, entry.part);
        fmt::format_to(out, "    <DataSet timestep=\"{}\" group=\"\" part=\"{}\" name=\"{}\" file=\"{}\"/>\n",
                       entry.time, place - parts.begin(), escaped(entry.part), escaped(entry.file));
        if (place == parts.end()) parts.push_back(entry.part);
    }
    fmt::format_to(out, "  </Collection>\n</VTKFile>\n");
    write_atomic(path_, {text.data(), text.size()});
}

} // namespace osculate::output
