#pragma once
/// Plots that a scene asks for, drawn from the tables of its run.

#include "osculate/app/compile.hpp"
#include "osculate/core/error.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace osculate::app {

/// Whether every curve can be drawn from the tables that the run will write.
/// @param faults  gets names of tables that are none, and formulas that are none over their columns
void check_plots(const scene::Scene& scene, const Plan& plan, std::vector<Fault>& faults);

/// Removes what an earlier run left. @throws std::runtime_error with path and reason
void remove_plots(const std::filesystem::path& folder);

/// Writes plots/NAME.csv and plots/NAME.gp of every plot that has a curve, and lets gnuplot draw them, where there is one.
/// @returns  a line for the user, empty where all went well; never throws, as a picture is no reason to lose a run
[[nodiscard]] std::string write_plots(const scene::Scene& scene, const std::filesystem::path& folder) noexcept;

} // namespace osculate::app
