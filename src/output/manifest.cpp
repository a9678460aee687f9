#include "output/manifest.hpp"

#include "osculate/core/error.hpp"
#include "osculate/core/file_content.hpp"
#include "osculate/core/printable.hpp"
#include "osculate/output/output_folder.hpp"

#include <algorithm>
#include <charconv>
#include <fmt/format.h>
#include <string_view>
#include <vector>

namespace osculate::output {

namespace fs = std::filesystem;

namespace {

constexpr std::string_view head = "osculate manifest 1, process ";

/// Whether a path stays below the folder that it is relative to, links apart.
bool is_inside(const std::string& text) {
    if (text.empty() || text.back() == '/' || find_control(text) != std::string::npos || text == OutputFolder::manifest)
        return false;
    const fs::path path(text);
    return !path.is_absolute() &&
           std::ranges::none_of(path, [](const fs::path& part) { return part == ".." || part == "." || part.empty(); });
}

} // namespace

std::string text_of(const Manifest& manifest) {
    return fmt::format("{}{}\n{}{}", head, manifest.process, fmt::join(manifest.files, "\n"),
                       manifest.files.empty() ? "" : "\n");
}

std::optional<Manifest> read_manifest(const fs::path& path) {
    std::error_code failed;
    if (!fs::is_regular_file(fs::symlink_status(path, failed))) return {};
    const std::string text = file_content(path, failed);
    if (failed || !text.starts_with(head)) return {};
    Manifest manifest;
    std::vector<Fault> faults;
    int number = 1;
    for (std::size_t at = 0, end = 0; (end = text.find('\n', at)) != std::string::npos; at = end + 1, ++number) {
        const std::string line = text.substr(at, end - at);
        if (number == 1) {
            std::from_chars(line.data() + head.size(), line.data() + line.size(), manifest.process);
        } else if (is_inside(line)) {
            manifest.files.insert(line);
        } else {
            faults.push_back({path.string(), number, 1, "", "the path of a file inside the folder",
                              "'" + printable(line) + "'", ""});
        }
    }
    if (!faults.empty()) throw SceneError(std::move(faults));
    return manifest;
}

} // namespace osculate::output
