#pragma once
/// Plots of a run as files, by gnuplot.

#include "osculate/output/output_folder.hpp"

#include <string>

namespace osculate::app {

/// Writes report/plots.gp in the folder of a run and, with gnuplot, draws report/{contact,reactions,energies,steps}.svg
/// and .png of what the run has.
/// @returns  a sentence where plots are missing; empty: all are drawn
/// @throws std::runtime_error where the script cannot be written
[[nodiscard]] std::string write_report_plots(output::OutputFolder& run);

} // namespace osculate::app
