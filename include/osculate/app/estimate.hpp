#pragma once
/// Estimated cost of a run of a plan.

#include "osculate/app/compile.hpp"

#include <vector>

namespace osculate::app {

struct Estimate {
    double steps = 0;   ///< as in the stages; cut steps are additional
    double seconds = 0; ///< of one processor
    double bytes = 0;   ///< peak memory
    /// The 98 shipped scenes of docs/data/estimates.csv, to which the figures are fitted, cost between estimate /
    /// factor and estimate * factor, except ten that its test names, most of whose tangents are factorised repeatedly.
    static constexpr double factor = 3;
};

/// One contribution to the processor time.
struct CostTerm {
    const char* what;
    double count;   ///< in the whole run
    double seconds; ///< per count; fitted by `scripts/pages/estimates --fit` to docs/data/estimates.csv
};
[[nodiscard]] std::vector<CostTerm> cost_terms(const scene::Scene& scene, const Plan& plan);

/// Estimates from counts of the plan and figures measured on one processor of a server of 2020; scenes with cut steps,
/// and failing scenes, take longer.
[[nodiscard]] Estimate estimate(const scene::Scene& scene, const Plan& plan);

} // namespace osculate::app
