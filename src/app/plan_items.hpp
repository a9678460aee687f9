#pragma once
/// What `osculate explain` shows of a plan.

#include "osculate/app/compile.hpp"

#include <vector>

namespace osculate::app {

/// Every part that a plan may hold, with the reason why it is there or left out.
[[nodiscard]] std::vector<PlanItem> plan_items(const scene::Scene& scene, const Plan& plan);

} // namespace osculate::app
