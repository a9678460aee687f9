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
    /// Of the variables' values, in their order; what it has no value for is NaN. Not for several threads at once.
    std::function<double(std::span<const double>)> function{};
    std::vector<std::string> uses{}; ///< the variables it depends on
    std::string problem{};           ///< why the text is no formula; empty when it is one
    std::string nearest{};           ///< the known name nearest to an unknown one
};

/// A formula with the given variables, the constants pi and e, muparser's functions and those given. Names may hold dots.
[[nodiscard]] ParsedFormula parse_formula(const std::string& text, const std::vector<std::string>& variables,
                                          const NamedFunctions& functions = {});

/// Whether a variable may have this name: letters, digits and _, no digit first, and no name that formulas know already.
[[nodiscard]] bool is_variable_name(const std::string& name, const NamedFunctions& functions = {});

} // namespace osculate::scene
