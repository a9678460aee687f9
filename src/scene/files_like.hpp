#pragma once
/// Files by a pattern of their names.

#include <filesystem>
#include <vector>

namespace osculate::scene {

/// Files of the pattern's folder whose names are as its last part says, sorted; * stands for any characters, ? for one.
[[nodiscard]] std::vector<std::filesystem::path> files_like(const std::filesystem::path& pattern);

} // namespace osculate::scene
