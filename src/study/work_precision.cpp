#include "osculate/study/work_precision.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace osculate::study {

namespace {

bool has_logarithms(const CostPoint& p) {
    return std::isfinite(p.cost) && std::isfinite(p.error) && p.cost > 0 && p.error > 0;
}

/// Points with logarithms on the Pareto front, by cost: errors fall.
std::vector<CostPoint> front_of(const std::vector<CostPoint>& points) {
    std::vector<CostPoint> usable, front;
    std::ranges::copy_if(points, std::back_inserter(usable), has_logarithms);
    for (const std::size_t i : pareto_front(usable)) front.push_back(usable[i]);
    return front;
}

/// @pre error lies between those of the front's ends
double cost_at(const std::vector<CostPoint>& front, double error) {
    for (std::size_t i = 1; i < front.size(); ++i) {
        const CostPoint &a = front[i - 1], &b = front[i];
        if (error < b.error) continue;
        const double part = std::log(a.error / std::min(error, a.error)) / std::log(a.error / b.error);
        return a.cost * std::pow(b.cost / a.cost, part);
    }
    return front.back().cost;
}

} // namespace

double PowerLaw::operator()(double cost) const {
    return factor * std::pow(cost, slope);
}

std::optional<PowerLaw> fit_power_law(const std::vector<CostPoint>& points) {
    double n = 0, x = 0, y = 0, xx = 0, xy = 0;
    PowerLaw law{0, 0, std::numeric_limits<double>::infinity(), 0};
    for (const CostPoint& p : points) {
        if (!has_logarithms(p)) continue;
        const double lx = std::log(p.cost), ly = std::log(p.error);
        n += 1, x += lx, y += ly, xx += lx * lx, xy += lx * ly;
        law.least = std::min(law.least, p.cost);
        law.largest = std::max(law.largest, p.cost);
    }
    constexpr double same = 1 + 1e-9; // costs that differ by round-off have no slope
    if (n < 2 || law.largest < same * law.least) return {};
    law.slope = (n * xy - x * y) / (n * xx - x * x);
    law.factor = std::exp((y - law.slope * x) / n);
    return law;
}

std::vector<std::size_t> pareto_front(const std::vector<CostPoint>& points) {
    std::vector<std::size_t> order;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (std::isfinite(points[i].cost) && std::isfinite(points[i].error) && points[i].error >= 0) order.push_back(i);
    std::ranges::stable_sort(order, [&](std::size_t i, std::size_t j) {
        return points[i].cost != points[j].cost ? points[i].cost < points[j].cost : points[i].error < points[j].error;
    });
    std::vector<std::size_t> front;
    for (const std::size_t i : order)
        if (front.empty() || points[i].error < points[front.back()].error) front.push_back(i);
    return front;
}

std::optional<CostRatio> cost_ratio(const std::vector<CostPoint>& first, const std::vector<CostPoint>& second) {
    const std::vector<CostPoint> a = front_of(first), b = front_of(second);
    if (a.empty() || b.empty()) return {};
    CostRatio result;
    result.least = std::max(a.back().error, b.back().error);
    result.largest = std::min(a.front().error, b.front().error);
    if (result.least > result.largest) return {};
    result.error = std::sqrt(result.least * result.largest);
    result.ratio = cost_at(a, result.error) / cost_at(b, result.error);
    return result;
}

double median(std::vector<double> values) {
    std::ranges::sort(values);
    const std::size_t n = values.size();
    return n % 2 == 1 ? values[n / 2] : (values[n / 2 - 1] + values[n / 2]) / 2;
}

} // namespace osculate::study
