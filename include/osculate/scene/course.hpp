#pragma once
/// Values of loads and motions over the time of a stage.

#include <array>
#include <functional>
#include <string>
#include <variant>
#include <vector>

namespace osculate::scene {

/// Linear between its rows, constant before the first and after the last.
struct Table {
    std::vector<std::array<double, 2>> rows; ///< time since the stage's start, s, ascending; value, SI
    [[nodiscard]] double at(double t) const; ///< @pre there is a row
    bool operator==(const Table&) const = default;
};

/// A formula in t, seconds since the stage's start, with the constants pi and e.
struct Expression {
    std::string text{};
    std::string unit{}; ///< unit of its values, as written
    double size = 1;    ///< value of the unit, SI
    bool operator==(const Expression&) const = default;
};

/// A constant value, or one that changes during its stage.
struct Course {
    std::variant<double, Table, Expression> form;

    Course(double value = 0) : form(value) {} // NOLINT: a number is a course
    Course(Table table) : form(std::move(table)) {}
    Course(Expression expression) : form(std::move(expression)) {}

    [[nodiscard]] bool is_value() const { return std::holds_alternative<double>(form); }
    [[nodiscard]] double value() const { return std::get<double>(form); } ///< @pre is_value()
    /// Value, SI, as function of the time since the stage's start, s; NaN where an expression has no value. Not for
    /// simultaneous use by several threads.
    /// @throws std::invalid_argument if an expression cannot be parsed
    [[nodiscard]] std::function<double(double)> function() const;
    /// Times at which it may have a kink, s, ascending.
    [[nodiscard]] std::vector<double> corners() const;
    bool operator==(const Course&) const = default;
};

struct ParsedExpression {
    std::function<double(double)> function{}; ///< of t, without a unit
    std::string problem{};                    ///< why the text is no expression; empty if it is one
    std::string nearest{};                    ///< the known name nearest to an unknown one
};

[[nodiscard]] ParsedExpression parse_expression(const std::string& text);

} // namespace osculate::scene
