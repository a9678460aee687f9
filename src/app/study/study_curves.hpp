#pragma once
/// Quantities of a study over its axes: what curves and maps show, tables of them, sensitivities.

#include "app/study/study_case.hpp"
#include "osculate/study/sensitivity.hpp"

#include <optional>
#include <string>
#include <vector>

namespace osculate::app {

struct CurvePoint {
    std::size_t value = 0; ///< of the axis
    double x = 0;          ///< its place, or the number of the value where it has a name only
    double y = 0;
};

struct StudyCurve {
    std::string name;               ///< values of the other axes; empty where there is no other
    std::vector<CurvePoint> points; ///< by x; only of runs that have a value
};

/// A curve for every combination of the other axes, in the order of the runs.
[[nodiscard]] std::vector<StudyCurve> make_curves(const scene::Study& study, const std::vector<StudyCase>& cases,
                                                  const scene::StudyCurves& plot);

struct StudyMap {
    std::string name;
    std::vector<std::size_t> columns, rows;  ///< values of the first and of the second axis, by their place
    std::vector<std::vector<double>> values; ///< by row, then column; NaN where a run has none
};

[[nodiscard]] std::vector<StudyMap> make_maps(const scene::Study& study, const std::vector<StudyCase>& cases,
                                              const scene::StudyContours& plot);

/// The place of a value, or its number among the axis' values.
[[nodiscard]] double place_of(const scene::Study& study, const scene::StudyCoordinate& over, std::size_t value);
/// "friction", "E, MPa".
[[nodiscard]] std::string label_of(const scene::StudyCoordinate& over);
[[nodiscard]] std::string label_of(const scene::StudyQuantity& quantity);

/// Of a quantity to the variables of a sampled axis, over the runs of one combination of the other axes.
struct StudySensitivity {
    std::string name; ///< values of the other axes
    std::size_t runs = 0;
    std::optional<study::Sensitivity> values; ///< none where there are too few runs or nothing varies
};

[[nodiscard]] std::vector<StudySensitivity> make_sensitivities(const scene::Study& study,
                                                               const std::vector<StudyCase>& cases,
                                                               std::size_t quantity, std::size_t axis);

/// What study.md says of all of these; empty if there are none.
[[nodiscard]] std::string curve_sections(const scene::Study& study, const std::vector<StudyCase>& cases);

/// A table for each plot: <name>_curves.csv, <name>_contours.csv.
void write_curve_tables(const scene::Study& study, const std::vector<StudyCase>& cases,
                        const std::filesystem::path& folder);

/// gnuplot's commands that draw all of them; empty if there is nothing to draw.
[[nodiscard]] std::string curve_plots(const scene::Study& study, const std::vector<StudyCase>& cases);

/// Files of plots and tables, relative to the study's folder.
[[nodiscard]] std::vector<std::string> curve_files(const scene::Study& study);

} // namespace osculate::app
