#pragma once
/// Plots that a scene asks for, drawn from the tables of its run.

#include "osculate/app/compile.hpp"
#include "osculate/core/error.hpp"
#include "osculate/output/output_folder.hpp"

#include <string>
#include <vector>

namespace osculate::app {

/// Whether every curve can be drawn from the tables that the run will write.
/// @param faults  gets names of tables that are none, and formulas that are none over their columns
void check_plots(const scene::Scene& scene, const Plan& plan, std::vector<Fault>& faults);

/// Files of the scene's plots, relative to the folder of a run.
[[nodiscard]] std::vector<std::string> plot_files(const scene::Scene& scene);

/// Writes plots/NAME.csv and plots/NAME.gp of every plot that has a curve, and lets gnuplot draw them, where there is one.
/// @returns  a line for the user, empty where all went well; never throws, as a picture is no reason to lose a run
[[nodiscard]] std::string write_plots(const scene::Scene& scene, output::OutputFolder& files) noexcept;

} // namespace osculate::app
