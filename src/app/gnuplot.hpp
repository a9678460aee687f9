#pragma once
/// Pictures by an external program that need not be there.

#include <filesystem>
#include <string>

namespace osculate::app {

enum class Gnuplot { drawn, missing, failed };

/// Runs gnuplot on a script in its folder and waits for it.
[[nodiscard]] Gnuplot run_gnuplot(const std::filesystem::path& folder, const std::string& script);

} // namespace osculate::app
