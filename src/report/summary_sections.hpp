#pragma once
/// Sections of the page that tell what summary.json holds, as HTML; empty where it holds nothing of theirs.

#include "osculate/report/page.hpp"
#include "report/run_files.hpp"

#include <string>

namespace osculate::report {

/// @param last_time  s, of the last accepted step; NaN where there is none
[[nodiscard]] std::string key_figures(const RunFiles& files, double last_time);
[[nodiscard]] std::string mesh_section(const RunFiles& files);
[[nodiscard]] std::string checks_section(const RunFiles& files);
[[nodiscard]] std::string cost_section(const RunFiles& files);
/// The command and the scene that give the same run.
[[nodiscard]] std::string reproduce_section(const RunFiles& files);
[[nodiscard]] std::string about_section(const RunFiles& files, const PageOptions& options);

} // namespace osculate::report
