#pragma once
/// The scene's own plots, as the run left their points.

#include "osculate/scene/scene.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace osculate::report {

struct PlotCurve {
    std::string name;
    std::vector<double> x, y; ///< NaN where there is a gap
};

struct PlotFile {
    std::string title, x_label, y_label;
    std::vector<PlotCurve> curves;
};

/// The plots of the scene that plots/NAME.csv holds points of; one that cannot be read is noted.
[[nodiscard]] std::vector<PlotFile> read_plot_files(const std::filesystem::path& folder, const scene::Scene& scene,
                                                    std::vector<std::string>& notes);

} // namespace osculate::report
