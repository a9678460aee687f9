#pragma once
/// What a run of a plan will take, before it is run.

#include "osculate/app/compile.hpp"

#include <vector>

namespace osculate::app {

struct Estimate {
    double steps = 0;   ///< as many as the stages ask for; cuts come on top
    double seconds = 0; ///< of one processor
    double bytes = 0;   ///< peak memory
    /// Shipped scenes that complete take between the estimate over this and the estimate times this; see docs/data/estimates.csv.
    static constexpr double factor = 3;
};

/// One of the things that the processor's time goes into.
struct CostTerm {
    const char* what;
    double count;   ///< in the whole run
    double seconds; ///< each; fitted by `scripts/estimates --fit` to docs/data/estimates.csv
};
[[nodiscard]] std::vector<CostTerm> cost_terms(const scene::Scene& scene, const Plan& plan);

/// From counts of the plan and figures measured on one processor of a server of 2020; scenes whose steps are cut, or that
/// give up, take longer.
[[nodiscard]] Estimate estimate(const scene::Scene& scene, const Plan& plan);

} // namespace osculate::app
