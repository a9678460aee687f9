#pragma once
/// Where the files that come with Osculate are, in the build tree and in an install tree, wherever that was moved to.

#include <filesystem>
#include <string>

namespace osculate {

/// Folder of files that come with Osculate, by its path in the source tree: "output_templates", "configs/tutorials". The
/// first that exists of
///     $OSCULATE_DATA/name
///     share/osculate/name of the install tree that holds the program, or the shared library, which this is linked into
///     name in the source tree it was built from
///     share/osculate/name below the prefix it was configured for
/// @returns  the last of these where there is none of them
[[nodiscard]] std::filesystem::path data_folder(const std::string& name);

} // namespace osculate
