#pragma once
/// A quantity of a study, measured on one run.

#include "osculate/scene/study.hpp"

#include <limits>

namespace osculate::study {

/// Data of a quantity: its columns, in the order of scene::visible_columns, and the weight of every row.
struct QuantityRows {
    scene::Rows rows;
    std::vector<double> weights; ///< tributary areas, or time steps; empty: equal weights
};

struct Measured {
    double value = std::numeric_limits<double>::quiet_NaN();
    bool is_error = false; ///< whether the value is already the norm of a difference
};

/// @param numbers  scene::numbers_of the run
[[nodiscard]] Measured measure(const scene::StudyQuantity& quantity, const QuantityRows& rows,
                               const scene::Numbers& numbers, const scene::NamedFunctions& functions);

/// The error, divided by |reference| if requested and the reference is not 0.
[[nodiscard]] double error_of(const scene::StudyQuantity& quantity, double value, double reference);

/// Evaluates a formula of numbers; NaN for an empty text.
[[nodiscard]] double evaluate(const scene::StudyText& text, const scene::Numbers& numbers,
                              const scene::NamedFunctions& functions);

} // namespace osculate::study
