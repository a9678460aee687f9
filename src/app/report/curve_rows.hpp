#pragma once
/// Curves from rows of tables.

#include "osculate/scene/aggregate.hpp"
#include "osculate/scene/output.hpp"

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace osculate::app {

/// A formula without `*` in its names.
struct ExpandedFormula {
    std::string text;
    std::string match;       ///< what the `*` stands for here; empty: there was none
    bool of_several = false; ///< it stands for something else in another one
};

/// Names of columns as formulas can have them: '_' in place of '-'.
[[nodiscard]] std::vector<std::string> formula_names(std::vector<std::string> columns);

/// A formula for each thing that `*` in a name like pair.*.normal stands for, so that there is such a column; none where
/// there is none. A formula without `*` in a name stands for itself.
[[nodiscard]] std::vector<ExpandedFormula> expanded(const std::string& formula,
                                                    const std::vector<std::string>& columns);

/// Abscissae and ordinates of a curve; nothing where the table lacks a column. An ordinate may be NaN: no value.
[[nodiscard]] std::optional<std::pair<std::vector<double>, std::vector<double>>>
curve_points(const scene::Curve& curve, const ExpandedFormula& y, const scene::Rows& table);

} // namespace osculate::app
