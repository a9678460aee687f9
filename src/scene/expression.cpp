#include "osculate/scene/course.hpp"
#include "osculate/scene/nearest.hpp"

#include <limits>
#include <memory>
#include <muParser.h>
#include <numbers>
#include <string_view>

namespace osculate::scene {

namespace {

struct Formula {
    mu::Parser parser;
    double t = 0;
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

std::vector<std::string> known_names(const mu::Parser& parser) {
    std::vector<std::string> names{"t", "pi", "e"};
    for (const auto& [name, function] : parser.GetFunDef()) names.push_back(name);
    return names;
}

} // namespace

ParsedExpression parse_expression(const std::string& text) {
    const auto formula = std::make_shared<Formula>();
    if (assigns(text)) return {.problem = "'=' assigns; == compares"};
    try {
        formula->parser.DefineVar("t", &formula->t);
        formula->parser.DefineConst("pi", std::numbers::pi);
        formula->parser.DefineConst("e", std::numbers::e);
        formula->parser.SetExpr(text);
        (void)formula->parser.Eval(); // parses
        if (formula->parser.GetNumResults() != 1) return {.problem = "several values"};
    } catch (const mu::Parser::exception_type& error) {
        ParsedExpression result{.problem = error.GetMsg()};
        if (error.GetCode() == mu::ecUNASSIGNABLE_TOKEN)
            result.nearest = nearest(error.GetToken(), known_names(formula->parser));
        return result;
    }
    return {.function = [formula](double t) {
        formula->t = t;
        try {
            return formula->parser.Eval();
        } catch (const mu::Parser::exception_type&) { // a function outside its domain
            return std::numeric_limits<double>::quiet_NaN();
        }
    }};
}

} // namespace osculate::scene
