#include "osculate/scene/aggregate.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace osculate::scene {

namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

bool is_name_character(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.';
}

/// A call of one argument: where its name begins and where it ends, and what is in its brackets.
struct Call {
    std::string name, argument;
    std::size_t begin = 0, end = 0;
};

/// The first call of a reduction with a single argument at or behind `from`; an empty name when there is none.
Call next_call(const std::string& text, std::size_t from) {
    for (std::size_t i = from; i < text.size(); ++i) {
        if (!is_name_character(text[i])) continue;
        std::size_t end = i;
        while (end < text.size() && is_name_character(text[end])) ++end;
        const std::string name = text.substr(i, end - i);
        std::size_t open = end;
        while (open < text.size() && std::isspace(static_cast<unsigned char>(text[open]))) ++open;
        if (open < text.size() && text[open] == '(' && std::ranges::count(aggregate_names(), name) > 0) {
            int depth = 0;
            bool single = true;
            for (std::size_t k = open; k < text.size(); ++k) {
                depth += text[k] == '(' ? 1 : text[k] == ')' ? -1 : 0;
                single = single && !(text[k] == ',' && depth == 1);
                if (depth > 0) continue;
                if (single) return {name, text.substr(open + 1, k - open - 1), i, k + 1};
                break;
            }
        }
        i = end - 1;
    }
    return {};
}

std::vector<std::string> joined(std::vector<std::string> a, const std::vector<std::string>& b) {
    a.insert(a.end(), b.begin(), b.end());
    return a;
}

} // namespace

const std::vector<std::string>& aggregate_names() {
    static const std::vector<std::string> names{"max", "min", "sum", "mean", "rms", "first", "last", "count"};
    return names;
}

double reduce(const std::string& reduction, const std::vector<double>& values) {
    const double sum = std::accumulate(values.begin(), values.end(), 0.0);
    const auto n = static_cast<double>(values.size());
    if (reduction == "sum") return sum;
    if (reduction == "count")
        return static_cast<double>(std::ranges::count_if(values, [](double v) { return v != 0; }));
    if (values.empty()) return nan;
    if (std::ranges::any_of(values, [](double v) { return std::isnan(v); }) && reduction != "first" &&
        reduction != "last")
        return nan;
    const auto [least, largest] = std::ranges::minmax(values);
    if (reduction == "first") return values.front();
    if (reduction == "last") return values.back();
    if (reduction == "min") return least;
    if (reduction == "max") return largest;
    if (reduction == "mean") return sum / n;
    if (reduction == "rms") return std::sqrt(std::inner_product(values.begin(), values.end(), values.begin(), 0.0) / n);
    if (reduction == "amplitude") return largest - least;
    if (reduction == "ripple") return (largest - least) / std::abs(sum / n);
    if (reduction == "roughness") {
        // of the inner values a_1 ... a_n-2: their second differences over their mean, without the two ends of those
        if (values.size() < 5) return nan;
        double squares = 0, inner = 0;
        for (std::size_t i = 2; i + 2 < values.size(); ++i) {
            const double second = values[i - 1] - 2 * values[i] + values[i + 1];
            squares += second * second;
            inner += values[i];
        }
        return std::sqrt(squares * (n - 4)) / std::abs(inner);
    }
    throw std::invalid_argument("no reduction is called '" + reduction + "'");
}

std::vector<double> evaluate_rows(const ParsedFormula& formula, const Rows& rows, std::span<const double> numbers) {
    std::vector<double> values(rows.columns.size() + numbers.size()), result(rows.size());
    std::ranges::copy(numbers, values.begin() + static_cast<std::ptrdiff_t>(rows.columns.size()));
    for (std::size_t i = 0; i < rows.size(); ++i) {
        for (std::size_t c = 0; c < rows.columns.size(); ++c) values[c] = rows.columns[c][i];
        result[i] = formula.function(values);
    }
    return result;
}

Aggregate::Aggregate(const std::string& text, const std::vector<std::string>& row_variables,
                     const std::vector<std::string>& numbers, const NamedFunctions& functions) {
    std::string rest;
    std::vector<std::string> names = numbers;
    std::size_t at = 0;
    for (Call call = next_call(text, 0); !call.name.empty(); call = next_call(text, at)) {
        if (!next_call(call.argument, 0).name.empty()) {
            problem_ = "a reduction within " + call.name;
            return;
        }
        parts_.push_back({call.name, parse_formula(call.argument, joined(row_variables, numbers), functions)});
        if (!parts_.back().formula.problem.empty()) {
            fail(parts_.back().formula);
            return;
        }
        names.push_back("reduced_" + std::to_string(parts_.size()));
        rest += text.substr(at, call.begin - at) + names.back();
        at = call.end;
    }
    rest += text.substr(at);
    whole_ = parse_formula(rest, names, functions);
    if (whole_.problem.empty()) return;
    fail(whole_);
    if (!parse_formula(rest, joined(names, row_variables), functions).problem.empty()) return;
    problem_ = "a value of every row where one number is due: " + aggregate_names()[0] + "(...) and the like make one";
    nearest_.clear();
}

void Aggregate::fail(const ParsedFormula& formula) {
    problem_ = formula.problem;
    nearest_ = formula.nearest;
}

double Aggregate::operator()(const Rows& rows, std::span<const double> numbers) const {
    std::vector<double> values(numbers.begin(), numbers.end());
    for (const Part& part : parts_)
        values.push_back(reduce(part.reduction, evaluate_rows(part.formula, rows, numbers)));
    return whole_.function(values);
}

} // namespace osculate::scene
