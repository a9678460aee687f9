#pragma once
/// Files as text.

#include <filesystem>
#include <string>
#include <system_error>

namespace osculate {

/// All bytes of a file, which may be a pipe.
/// @param error  why the file cannot be opened or read to its end; what comes back are then the bytes before that
[[nodiscard]] std::string file_content(const std::filesystem::path& path, std::error_code& error);

/// The same where a file that cannot be read counts as an empty one.
[[nodiscard]] std::string file_content(const std::filesystem::path& path);

} // namespace osculate
