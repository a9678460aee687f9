#pragma once
/// A quantity of a study, measured on one run.

#include "osculate/scene/study.hpp"

#include <limits>

namespace osculate::study {

/// What a quantity looks at: its columns, in the order of scene::visible_columns, and the weight of every row.
struct QuantityRows {
    scene::Rows rows;
    std::vector<double> weights; ///< tributary areas, or time steps; empty: all alike
};

struct Measured {
    double value = std::numeric_limits<double>::quiet_NaN();
    bool is_error = false; ///< the value is the norm of a difference already
};

/// @param numbers  scene::numbers_of the run
[[nodiscard]] Measured measure(const scene::StudyQuantity& quantity, const QuantityRows& rows,
                               const scene::Numbers& numbers, const scene::NamedFunctions& functions);

/// Over |reference| where that is asked for and it is not 0.
[[nodiscard]] double error_of(const scene::StudyQuantity& quantity, double value, double reference);

/// A formula of numbers alone; NaN for no text.
[[nodiscard]] double evaluate(const scene::StudyText& text, const scene::Numbers& numbers,
                              const scene::NamedFunctions& functions);

} // namespace osculate::study
