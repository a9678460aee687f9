#pragma once
/// What a run of a plan will take, before it is run.

#include "osculate/app/compile.hpp"

#include <vector>

namespace osculate::app {

struct Estimate {
    double steps = 0;   ///< as many as the stages ask for; cuts come on top
    double seconds = 0; ///< of one processor
    double bytes = 0;   ///< peak memory
    /// The 98 shipped scenes of docs/data/estimates.csv, to which the figures are fitted, take between the estimate over this and
    /// the estimate times this, but for two whose tangents are factorised again and again.
    static constexpr double factor = 3;
};

/// One of the things that the processor's time goes into.
struct CostTerm {
    const char* what;
    double count;   ///< in the whole run
    double seconds; ///< each; fitted by `scripts/pages/estimates --fit` to docs/data/estimates.csv
};
[[nodiscard]] std::vector<CostTerm> cost_terms(const scene::Scene& scene, const Plan& plan);

/// From counts of the plan and figures measured on one processor of a server of 2020; scenes whose steps are cut, or that
/// give up, take longer.
[[nodiscard]] Estimate estimate(const scene::Scene& scene, const Plan& plan);

} // namespace osculate::app
