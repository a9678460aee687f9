#pragma once
/// Writing files of a run: one wording of errors, and whole files at once.

#include <filesystem>
#include <string_view>
#include <system_error>

namespace osculate::output {

/// Throws std::runtime_error with path and reason.
[[noreturn]] void throw_unwritable(const std::filesystem::path& path, const std::error_code& reason);

/// Makes the folder a file is to lie in, when it is missing.
/// @throws std::runtime_error with path and reason
void make_folder_of(const std::filesystem::path& path);

/// Writes `content` to a file beside `path` and renames it: a reader sees the file of before or the whole new one.
/// Makes the folder when it is missing.
/// @throws std::runtime_error with path and reason; the file of before is then untouched and nothing else is left
/// @param durable  content and name have reached the disk when it returns
void write_atomic(const std::filesystem::path& path, std::string_view content, bool durable = false);

/// What has been written to a file, or listed in a folder, has reached the disk when it returns.
/// @throws std::runtime_error with path and reason
void sync(const std::filesystem::path& path);

} // namespace osculate::output
