#pragma once
/// Error against cost: slopes, Pareto fronts, and cost ratios of two series.

#include <cstddef>
#include <optional>
#include <vector>

namespace osculate::study {

struct CostPoint {
    double cost = 0, error = 0;
};

/// error = factor cost^slope, by least squares of the logarithms.
struct PowerLaw {
    double slope = 0, factor = 0;
    double least = 0, largest = 0; ///< cost
    [[nodiscard]] double operator()(double cost) const;
};

/// No value for fewer than two points of different cost; ignores points whose cost or error is not positive and finite.
[[nodiscard]] std::optional<PowerLaw> fit_power_law(const std::vector<CostPoint>& points);

/// Indices of the Pareto-optimal points, by cost: no other point is at least as good in both and better in one. The
/// first of equals. Points that are not finite or negative are never included.
[[nodiscard]] std::vector<std::size_t> pareto_front(const std::vector<CostPoint>& points);

struct CostRatio {
    double ratio = 0;              ///< cost of the first divided by that of the second at
    double error = 0;              ///< the geometric mean of
    double least = 0, largest = 0; ///< the bounds of the errors that both reach
};

/// Costs are interpolated on the Pareto front of each series, linearly in logarithms. No value if the series share no
/// error.
[[nodiscard]] std::optional<CostRatio> cost_ratio(const std::vector<CostPoint>& first,
                                                  const std::vector<CostPoint>& second);

[[nodiscard]] double median(std::vector<double> values); ///< @pre there is at least one

} // namespace osculate::study
