#include "osculate/core/without_traps.hpp"
#include "osculate/scene/course.hpp"
#include "osculate/scene/formula.hpp"
#include "osculate/scene/nearest.hpp"

#include <algorithm>
#include <cctype>
#include <limits>
#include <memory>
#include <muParser.h>
#include <numbers>
#include <string_view>

namespace osculate::scene {

namespace {

constexpr const char* name_characters = "0123456789_.abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ";

struct Formula {
    mu::Parser parser;
    std::vector<double> values;
    NamedFunctions functions; ///< the parser points to them
};

/// muparser takes "t = 1" for an assignment to t.
bool assigns(std::string_view text) {
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] != '=') continue;
        if (i + 1 < text.size() && text[i + 1] == '=')
            ++i;
        else if (i == 0 || std::string_view("<>!").find(text[i - 1]) == std::string_view::npos)
            return true;
    }
    return false;
}

double call(void* data, const double* arguments, int count) {
    const auto& function = *static_cast<const NamedFunction*>(data);
    if (count != function.parameters)
        throw mu::ParserError(function.name + " takes " + std::to_string(function.parameters) + " numbers, not " +
                              std::to_string(count));
    return function.value(arguments);
}

std::vector<std::string> known_names(const mu::Parser& parser, const std::vector<std::string>& variables) {
    std::vector<std::string> names = variables;
    names.insert(names.end(), {"pi", "e"});
    for (const auto& [name, function] : parser.GetFunDef()) names.push_back(name);
    return names;
}

} // namespace

ParsedFormula parse_formula(const std::string& text, const std::vector<std::string>& variables,
                            const NamedFunctions& functions) {
    const auto formula = std::make_shared<Formula>();
    if (assigns(text)) return {.problem = "'=' assigns; == compares"};
    ParsedFormula result;
    mu::Parser& parser = formula->parser;
    formula->values.assign(variables.size(), 1); // few functions are without a value there
    formula->functions = functions;
    try {
        parser.DefineNameChars(name_characters);
        for (std::size_t i = 0; i < variables.size(); ++i) parser.DefineVar(variables[i], &formula->values[i]);
        parser.DefineConst("pi", std::numbers::pi);
        parser.DefineConst("e", std::numbers::e);
        for (NamedFunction& function : formula->functions)
            parser.DefineFunUserData(function.name, call, &function, false);
        parser.SetExpr(text);
        const WithoutTraps constants; // are folded here
        (void)parser.Eval();          // parses
        if (parser.GetNumResults() != 1) return {.problem = "several values"};
        for (const auto& [name, address] : parser.GetUsedVar()) result.uses.push_back(name);
    } catch (const mu::Parser::exception_type& error) {
        ParsedFormula failed{.problem = error.GetMsg()};
        if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN)
            failed.nearest = nearest(error.GetToken(), known_names(parser, variables));
        return failed;
    }
    result.function = [formula](std::span<const double> values) {
        std::ranges::copy(values, formula->values.begin());
        const WithoutTraps evaluation;
        try {
            return formula->parser.Eval();
        } catch (const mu::Parser::exception_type&) { // a function outside its domain
            return std::numeric_limits<double>::quiet_NaN();
        }
    };
    return result;
}

bool is_variable_name(const std::string& name, const NamedFunctions& functions) {
    const auto fits = [](unsigned char c) { return std::isalnum(c) || c == '_'; };
    if (name.empty() || std::isdigit(static_cast<unsigned char>(name.front())) || !std::ranges::all_of(name, fits))
        return false;
    const mu::Parser parser;
    return std::ranges::count(known_names(parser, {}), name) == 0 &&
           std::ranges::count(functions, name, &NamedFunction::name) == 0;
}

ParsedExpression parse_expression(const std::string& text) {
    ParsedFormula formula = parse_formula(text, {"t"});
    if (!formula.problem.empty()) return {.problem = formula.problem, .nearest = formula.nearest};
    return {.function = [f = std::move(formula.function)](double t) { return f({&t, 1}); }};
}

} // namespace osculate::scene
