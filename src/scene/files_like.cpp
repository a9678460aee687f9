#include "scene/files_like.hpp"

#include <algorithm>
#include <string>
#include <string_view>

namespace osculate::scene {

namespace fs = std::filesystem;

namespace {

bool matches(std::string_view pattern, std::string_view name) {
    if (pattern.empty()) return name.empty();
    if (pattern.front() == '*')
        return matches(pattern.substr(1), name) || (!name.empty() && matches(pattern, name.substr(1)));
    return !name.empty() && (pattern.front() == '?' || pattern.front() == name.front()) &&
           matches(pattern.substr(1), name.substr(1));
}

} // namespace

std::vector<fs::path> files_like(const fs::path& pattern) {
    std::vector<fs::path> files;
    const std::string wanted = pattern.filename().string();
    std::error_code none;
    for (const auto& entry : fs::directory_iterator(pattern.parent_path(), none)) {
        const std::string name = entry.path().filename().string();
        const bool hidden = name.starts_with('.') && !wanted.starts_with('.'); // drafts of editors, as shells do
        if (!hidden && entry.is_regular_file(none) && matches(wanted, name)) files.push_back(entry.path());
    }
    std::ranges::sort(files); // folders have no order of their own
    return files;
}

} // namespace osculate::scene
