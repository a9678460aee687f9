#pragma once
/// Files as text.

#include <filesystem>
#include <string>
#include <system_error>

namespace osculate {

/// All bytes of a file, which may be a pipe.
/// @param error  why the file cannot be opened or read to its end; the result is then the bytes before that point. A pipe to which
///               nothing is written for 10 s gives timed_out; a device or pipe of more than 256 MB, file_too_large
[[nodiscard]] std::string file_content(const std::filesystem::path& path, std::error_code& error);

/// The same, but a file that cannot be read counts as empty.
[[nodiscard]] std::string file_content(const std::filesystem::path& path);

/// Writes a text as the whole content of a file.
/// @throws RunFailure naming the path
void write_text(const std::filesystem::path& path, const std::string& text);

} // namespace osculate
