#include "osculate/scene/course.hpp"

#include <algorithm>
#include <stdexcept>

namespace osculate::scene {

double Table::at(double t) const {
    const auto after = std::ranges::find_if(rows, [t](const auto& row) { return row[0] > t; });
    if (after == rows.begin()) return rows.front()[1];
    if (after == rows.end()) return rows.back()[1];
    const auto& [t0, y0] = *(after - 1);
    const auto& [t1, y1] = *after;
    return y0 + (t - t0) / (t1 - t0) * (y1 - y0);
}

std::function<double(double)> Course::function() const {
    if (const double* constant = std::get_if<double>(&form)) return [y = *constant](double) { return y; };
    if (const Table* table = std::get_if<Table>(&form)) return [rows = *table](double t) { return rows.at(t); };
    const auto& expression = std::get<Expression>(form);
    ParsedExpression parsed = parse_expression(expression.text);
    if (!parsed.function) throw std::invalid_argument(parsed.problem);
    return [f = std::move(parsed.function), size = expression.size](double t) { return size * f(t); };
}

std::vector<double> Course::corners() const {
    std::vector<double> times;
    if (const Table* table = std::get_if<Table>(&form))
        for (const auto& row : table->rows) times.push_back(row[0]);
    return times;
}

} // namespace osculate::scene
