#pragma once
/// Formulas in named variables.

#include <functional>
#include <span>
#include <string>
#include <vector>

namespace osculate::scene {

/// A function that formulas may call, with a fixed number of arguments.
struct NamedFunction {
    std::string name;
    int parameters = 0;
    double (*value)(const double* arguments) = nullptr;
};
using NamedFunctions = std::vector<NamedFunction>;

struct ParsedFormula {
    /// Function of the variables' values, in their order; NaN where it has no value. Not for simultaneous use by
    /// several threads.
    std::function<double(std::span<const double>)> function{};
    std::vector<std::string> uses{}; ///< the variables it depends on
    std::string problem{};           ///< why the text is no formula; empty if it is one
    std::string nearest{};           ///< the known name nearest to an unknown one
};

/// Parses a formula with the given variables and functions, the constants pi and e, and muparser's functions. Names may
/// contain dots.
[[nodiscard]] ParsedFormula parse_formula(const std::string& text, const std::vector<std::string>& variables,
                                          const NamedFunctions& functions = {});

/// Whether a variable may have this name: letters, digits and _, no digit first, and no name that formulas already
/// know.
[[nodiscard]] bool is_variable_name(const std::string& name, const NamedFunctions& functions = {});

} // namespace osculate::scene
