#pragma once
/// A study's cases as lines of a plot.

#include "app/study/study_case.hpp"
#include "osculate/study/work_precision.hpp"

#include <optional>
#include <string>
#include <vector>

namespace osculate::app {

/// Cases that differ along the refined axis only.
struct StudySeries {
    std::string name;                    ///< values of the other axes
    std::vector<const StudyCase*> cases; ///< finished ones
    int colour = 0, style = 0;           ///< numbers of the values of the axes that colour and of the others
    scene::Combination problem{};        ///< values of the study's `problems`
};

/// Names of the values of all axes but some: "blend, steps 30".
[[nodiscard]] std::string name_of_others(const scene::Study& study, const scene::Combination& combination,
                                         const std::vector<std::size_t>& without);

[[nodiscard]] std::vector<StudySeries> make_series(const scene::Study& study, const std::vector<StudyCase>& cases);

/// Error of a quantity over CPU seconds.
[[nodiscard]] std::vector<study::CostPoint> work_points(const StudySeries& series, std::size_t quantity);

/// What errors are plotted against along the refined axis.
[[nodiscard]] double abscissa(const scene::Study& study, const StudyCase& study_case);
[[nodiscard]] std::string abscissa_label(const scene::Study& study);
[[nodiscard]] std::vector<study::CostPoint> convergence_points(const scene::Study& study, const StudySeries& series,
                                                               std::size_t quantity);

/// Whether any error of a quantity is one over its reference.
[[nodiscard]] bool is_relative(const scene::StudyQuantity& quantity, const std::vector<StudyCase>& cases,
                               std::size_t index);

/// Cases on the Pareto front of a quantity, all series of one problem together, problem by problem, by cost.
[[nodiscard]] std::vector<const StudyCase*> pareto_cases(const scene::Study& study, const std::vector<StudyCase>& cases,
                                                         std::size_t quantity);

} // namespace osculate::app
