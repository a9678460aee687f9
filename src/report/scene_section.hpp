#pragma once
/// The scene in words, as sections of the page.

#include "report/run_files.hpp"

#include <string>

namespace osculate::report {

/// Bodies, supports, pairs, stages; empty where the scene cannot be read.
[[nodiscard]] std::string scene_section(const RunFiles& files);

} // namespace osculate::report
