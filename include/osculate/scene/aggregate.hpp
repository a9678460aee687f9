#pragma once
/// Formulas over rows of a table: sqrt(sum(area * (status > 0)) / pi).

#include "osculate/scene/formula.hpp"

#include <memory>
#include <string>
#include <vector>

namespace osculate::scene {

/// Columns of equal length by name.
struct Rows {
    std::vector<std::string> names;
    std::vector<std::vector<double>> columns;
    [[nodiscard]] std::size_t size() const { return columns.empty() ? 0 : columns.front().size(); }
};

/// Numbers by name.
struct Numbers {
    std::vector<std::string> names;
    std::vector<double> values;
    void add(const std::string& name, double value) {
        names.push_back(name);
        values.push_back(value);
    }
};

/// max, min, sum, mean, rms, first, last and count of a single argument go over all rows; what stands around them is a
/// formula of single numbers.
class Aggregate {
public:
    /// @param row_variables  columns of the tables it will see
    /// @param numbers        names of what is the same for all rows
    Aggregate(const std::string& text, const std::vector<std::string>& row_variables,
              const std::vector<std::string>& numbers, const NamedFunctions& functions);

    [[nodiscard]] const std::string& problem() const { return problem_; } ///< empty when the text is a formula
    [[nodiscard]] const std::string& nearest() const { return nearest_; }

    /// @param numbers  values in the order of the names given; the columns of `rows` are those given
    /// @returns NaN where it has no value, as max has none of no row
    [[nodiscard]] double operator()(const Rows& rows, std::span<const double> numbers) const;

private:
    struct Part {
        std::string reduction;
        ParsedFormula formula; ///< of (row variables, numbers)
    };
    void fail(const ParsedFormula& formula);

    std::vector<Part> parts_;
    ParsedFormula whole_; ///< of (numbers, parts)
    std::string problem_, nearest_;
};

/// A reduction by its name, of values in their order. @throws std::invalid_argument for a name that is none
[[nodiscard]] double reduce(const std::string& reduction, const std::vector<double>& values);
[[nodiscard]] const std::vector<std::string>& aggregate_names();

/// A formula of (row variables, numbers) for every row.
[[nodiscard]] std::vector<double> evaluate_rows(const ParsedFormula& formula, const Rows& rows,
                                                std::span<const double> numbers);

} // namespace osculate::scene
