#include "osculate/study/quantity.hpp"

#include "osculate/core/error.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace osculate::study {

namespace {

/// The rows a formula selects, in the order another gives.
QuantityRows chosen(const scene::StudyQuantity& q, const QuantityRows& all, const scene::Numbers& numbers,
                    const std::vector<std::string>& names, const scene::NamedFunctions& functions) {
    std::vector<std::size_t> order(all.rows.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    if (!q.where.empty()) {
        const auto keep =
            scene::evaluate_rows(scene::parse_formula(q.where.text, names, functions), all.rows, numbers.values);
        std::erase_if(order, [&](std::size_t i) { return keep[i] == 0 || std::isnan(keep[i]); });
    }
    if (!q.order_by.empty()) {
        const auto key =
            scene::evaluate_rows(scene::parse_formula(q.order_by.text, names, functions), all.rows, numbers.values);
        std::ranges::stable_sort(order, [&](std::size_t i, std::size_t j) { return key[i] < key[j]; });
    }
    QuantityRows result;
    result.rows.names = all.rows.names;
    for (const std::vector<double>& column : all.rows.columns) {
        std::vector<double>& copy = result.rows.columns.emplace_back();
        for (const std::size_t i : order) copy.push_back(column[i]);
    }
    if (!all.weights.empty())
        for (const std::size_t i : order) result.weights.push_back(all.weights[i]);
    return result;
}

double norm(scene::ErrorNorm kind, const std::vector<double>& difference, const std::vector<double>& weights) {
    double sum = 0, whole = 0, largest = 0;
    for (std::size_t i = 0; i < difference.size(); ++i) {
        const double d = std::abs(difference[i]), w = weights.empty() ? 1 : weights[i];
        if (std::isnan(d)) return d;
        sum += w * (kind == scene::ErrorNorm::rms ? d * d : d);
        whole += w;
        largest = std::max(largest, d);
    }
    if (kind == scene::ErrorNorm::max) return difference.empty() ? std::nan("") : largest;
    return kind == scene::ErrorNorm::rms ? std::sqrt(sum / whole) : sum / whole;
}

} // namespace

double evaluate(const scene::StudyText& text, const scene::Numbers& numbers, const scene::NamedFunctions& functions) {
    if (text.empty()) return std::nan("");
    const scene::ParsedFormula formula = scene::parse_formula(text.text, numbers.names, functions);
    require(formula.problem.empty(), "formulas of a study are checked when it is read");
    return formula.function(numbers.values);
}

double error_of(const scene::StudyQuantity& q, double value, double reference) {
    const double difference = std::abs(value - reference);
    return q.relative && reference != 0 ? difference / std::abs(reference) : difference;
}

Measured measure(const scene::StudyQuantity& q, const QuantityRows& all, const scene::Numbers& numbers,
                 const scene::NamedFunctions& functions) {
    std::vector<std::string> names = all.rows.names;
    names.insert(names.end(), numbers.names.begin(), numbers.names.end());
    const QuantityRows rows = chosen(q, all, numbers, names, functions);
    if (!q.value.empty()) {
        const scene::Aggregate aggregate(q.value.text, all.rows.names, numbers.names, functions);
        return {aggregate(rows.rows, numbers.values), false};
    }
    std::vector<double> values =
        scene::evaluate_rows(scene::parse_formula(q.of.text, names, functions), rows.rows, numbers.values);
    if (q.exact.empty()) return {scene::reduce(q.reduce, values), false};
    const std::vector<double> exact =
        scene::evaluate_rows(scene::parse_formula(q.exact.text, names, functions), rows.rows, numbers.values);
    for (std::size_t i = 0; i < values.size(); ++i) values[i] -= exact[i];
    const double scale = q.scale.empty() ? 1 : evaluate(q.scale, numbers, functions);
    return {norm(q.norm, values, rows.weights) / std::abs(scale), true};
}

} // namespace osculate::study
