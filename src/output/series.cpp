#include "osculate/output/series.hpp"

#include "output/files.hpp"

#include <algorithm>
#include <fmt/format.h>
#include <iterator>
#include <string_view>
#include <utility>

namespace osculate::output {

namespace {
std::string escaped(std::string_view text) {
    std::string result;
    for (const char c : text) {
        switch (c) {
        case '&': result += "&amp;"; break;
        case '<': result += "&lt;"; break;
        case '>': result += "&gt;"; break;
        case '"': result += "&quot;"; break;
        default: result += c;
        }
    }
    return result;
}
} // namespace

Series::Series(std::filesystem::path directory) : path_(std::move(directory) / "series.pvd") {
    flush();
}

void Series::add(double time, const std::string& part_name, const std::string& relative_file) {
    const auto place = std::find(parts_.begin(), parts_.end(), part_name);
    const auto part = static_cast<std::size_t>(place - parts_.begin());
    if (place == parts_.end()) parts_.push_back(part_name);
    entries_.push_back({time, part, relative_file});
}

void Series::flush() {
    fmt::memory_buffer text;
    const auto out = std::back_inserter(text);
    fmt::format_to(out, "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\">\n  <Collection>\n");
    for (const Entry& entry : entries_)
        fmt::format_to(out, "    <DataSet timestep=\"{}\" group=\"\" part=\"{}\" name=\"{}\" file=\"{}\"/>\n",
                       entry.time, entry.part, escaped(parts_[entry.part]), escaped(entry.file));
    fmt::format_to(out, "  </Collection>\n</VTKFile>\n");
    write_atomic(path_, {text.data(), text.size()});
}

} // namespace osculate::output
