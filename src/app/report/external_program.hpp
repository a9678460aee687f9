#pragma once
/// Programs that need not be there.

#include <filesystem>
#include <string>
#include <vector>

namespace osculate::app {

enum class External { done, missing, failed };

/// Runs a program of the search path in a folder and waits for it.
/// @param words  its name, then its arguments  @param quiet  what it says is of no concern
[[nodiscard]] External run_external(const std::filesystem::path& folder, const std::vector<std::string>& words,
                                    bool quiet = false);

} // namespace osculate::app
