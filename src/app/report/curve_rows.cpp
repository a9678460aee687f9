#include "app/report/curve_rows.hpp"

#include <algorithm>
#include <cmath>
#include <regex>

namespace osculate::app {

namespace {

/// A name with one `*` between dots.
const std::regex& starred() {
    static const std::regex pattern(R"(([A-Za-z_][A-Za-z_0-9.]*\.)\*(\.[A-Za-z_0-9.]*[A-Za-z_0-9]))");
    return pattern;
}

} // namespace

std::vector<std::string> formula_names(std::vector<std::string> columns) {
    for (std::string& name : columns) std::ranges::replace(name, '-', '_');
    return columns;
}

std::vector<ExpandedFormula> expanded(const std::string& formula, const std::vector<std::string>& columns) {
    std::smatch found;
    if (!std::regex_search(formula, found, starred())) return {{formula, {}, false}};
    const std::string before = found[1], after = found[2];
    std::vector<ExpandedFormula> all;
    for (const std::string& name : formula_names(columns)) {
        if (name.size() <= before.size() + after.size() || !name.starts_with(before) || !name.ends_with(after))
            continue;
        const std::string match = name.substr(before.size(), name.size() - before.size() - after.size());
        all.push_back({std::regex_replace(formula, starred(), "$1" + match + "$2"), match, false});
    }
    for (ExpandedFormula& one : all) one.of_several = all.size() > 1;
    return all;
}

std::optional<std::pair<std::vector<double>, std::vector<double>>>
curve_points(const scene::Curve& curve, const ExpandedFormula& y, const scene::Rows& table) {
    const auto column = [&](const std::string& text) -> std::optional<std::vector<double>> {
        const scene::ParsedFormula formula = scene::parse_formula(text, table.names);
        if (!formula.problem.empty()) return {};
        return scene::evaluate_rows(formula, table, {});
    };
    const auto xs = column(curve.x), ys = column(y.text);
    const auto keep = curve.where.empty() ? std::optional(std::vector<double>(table.size(), 1)) : column(curve.where);
    if (!xs || !ys || !keep) return {};
    const auto at = std::ranges::find(table.names, "time");
    const std::vector<double>* time =
        at == table.names.end() ? nullptr : &table.columns[static_cast<std::size_t>(at - table.names.begin())];
    std::pair<std::vector<double>, std::vector<double>> points;
    for (std::size_t i = 0; i < table.size(); ++i) {
        if ((*keep)[i] == 0 || std::isnan((*keep)[i]) || std::isnan((*xs)[i])) continue;
        if (curve.last && time != nullptr && (*time)[i] != time->back()) continue;
        points.first.push_back((*xs)[i]);
        points.second.push_back((*ys)[i]);
    }
    return points;
}

} // namespace osculate::app
