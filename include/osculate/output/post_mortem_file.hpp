#pragma once
/// post_mortem.json, and its content in words.

#include "osculate/time/post_mortem.hpp"

#include <filesystem>
#include <string>

namespace osculate::output {

constexpr const char* post_mortem_file = "post_mortem.json"; ///< in the folder of a failed run

/// Writes the post-mortem, completely or not at all. Numbers that are not finite become null.
/// @throws std::runtime_error with path and reason
void write_post_mortem(const std::filesystem::path& path, const time::PostMortem& found);
/// @throws std::runtime_error with path and reason if the file cannot be read or is not a post-mortem
[[nodiscard]] time::PostMortem read_post_mortem(const std::filesystem::path& path);

/// For human readers: several lines, the last ones with advice.
[[nodiscard]] std::string in_words(const time::PostMortem& found);

} // namespace osculate::output
