#pragma once
/// post_mortem.json, and what it says in words.

#include "osculate/time/post_mortem.hpp"

#include <filesystem>
#include <string>

namespace osculate::output {

constexpr const char* post_mortem_file = "post_mortem.json"; ///< in the folder of a run that gave up

/// Writes the post-mortem, whole or not at all. Numbers that are not finite become null.
/// @throws std::runtime_error with path and reason
void write_post_mortem(const std::filesystem::path& path, const time::PostMortem& found);
/// @throws std::runtime_error with path and reason where the file cannot be read or is none of ours
[[nodiscard]] time::PostMortem read_post_mortem(const std::filesystem::path& path);

/// For people: several lines, the last ones what to try.
[[nodiscard]] std::string in_words(const time::PostMortem& found);

} // namespace osculate::output
