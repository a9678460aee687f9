#pragma once
/// The text of a manifest: what a folder's files are that Osculate wrote.

#include <filesystem>
#include <optional>
#include <set>
#include <string>

namespace osculate::output {

struct Manifest {
    long process = 0; ///< that entered the folder last
    std::set<std::string> files;
};

/// A line that says what it is and who writes, then a path a line.
[[nodiscard]] std::string text_of(const Manifest& manifest);

/// Nothing where there is none: no file, a link, or a file of another kind. A last line without its end was never finished, and
/// its file not begun.
/// @throws SceneError with place where a path leads out of the folder
[[nodiscard]] std::optional<Manifest> read_manifest(const std::filesystem::path& path);

} // namespace osculate::output
