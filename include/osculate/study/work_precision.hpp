#pragma once
/// Error against cost: slopes, what is worth its cost, and how many times one series costs what another does.

#include <cstddef>
#include <optional>
#include <vector>

namespace osculate::study {

struct CostPoint {
    double cost = 0, error = 0;
};

/// error = factor cost^slope, least squares of logarithms.
struct PowerLaw {
    double slope = 0, factor = 0;
    double least = 0, largest = 0; ///< cost
    [[nodiscard]] double operator()(double cost) const;
};

/// None for fewer than two points of different cost; points whose cost or error is not positive and finite are left out.
[[nodiscard]] std::optional<PowerLaw> fit_power_law(const std::vector<CostPoint>& points);

/// Indices of the points that no other one is at least as good as in both and better in one, by cost. Of equals the first.
/// Points that are not finite or negative are never among them.
[[nodiscard]] std::vector<std::size_t> pareto_front(const std::vector<CostPoint>& points);

struct CostRatio {
    double ratio = 0;              ///< cost of the first over that of the second at
    double error = 0;              ///< the geometric middle of
    double least = 0, largest = 0; ///< the errors that both reach
};

/// Costs are read off the series' own Pareto fronts, linear in logarithms. None where the series share no error.
[[nodiscard]] std::optional<CostRatio> cost_ratio(const std::vector<CostPoint>& first,
                                                  const std::vector<CostPoint>& second);

[[nodiscard]] double median(std::vector<double> values); ///< @pre there is one

} // namespace osculate::study
