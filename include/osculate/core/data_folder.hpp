#pragma once
/// Where to find the files that come with Osculate, in the build tree and in an install tree, even if it was moved.

#include <filesystem>
#include <string>

namespace osculate {

/// Folder of files that come with Osculate, by its path in the source tree: "output_templates", "configs/tutorials".
/// Returns the first of these that exists:
///     $OSCULATE_DATA/name
///     share/osculate/name of the install tree that contains the program, or shared library, with this function
///     name in the source tree from which it was built
///     share/osculate/name below the prefix for which it was configured
/// @returns  the last of these if none exists
[[nodiscard]] std::filesystem::path data_folder(const std::string& name);

} // namespace osculate
