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

/// max, min, sum, mean, rms, first, last and count with a single argument are taken over all rows; the rest is a
/// formula of single numbers.
class Aggregate {
public:
    /// @param row_variables  column names of the tables to evaluate
    /// @param numbers        names of values that are the same for all rows
    Aggregate(const std::string& text, const std::vector<std::string>& row_variables,
              const std::vector<std::string>& numbers, const NamedFunctions& functions);

    [[nodiscard]] const std::string& problem() const { return problem_; } ///< empty when the text is a formula
    [[nodiscard]] const std::string& nearest() const { return nearest_; }

    /// @param numbers  values in the order of the given names; `rows` has the given columns
    /// @returns NaN if there is no value, such as max of no row
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

/// Reduces values, in their order, by the reduction with this name. @throws std::invalid_argument for an unknown name
[[nodiscard]] double reduce(const std::string& reduction, const std::vector<double>& values);
[[nodiscard]] const std::vector<std::string>& aggregate_names();

/// Evaluates a formula of (row variables, numbers) for every row.
[[nodiscard]] std::vector<double> evaluate_rows(const ParsedFormula& formula, const Rows& rows,
                                                std::span<const double> numbers);

} // namespace osculate::scene
