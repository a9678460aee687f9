#pragma once
/// Surfaces that more than one pair keeps apart.

#include "app/check/warning.hpp"
#include "osculate/app/compile.hpp"

#include <vector>

namespace osculate::app {

/// Of pairs that share facets of slave and master with another one, as it has them or the other way round: one condition
/// too many at every node, and forces that nothing tells apart.
[[nodiscard]] std::vector<Warning> twice_paired(const scene::Scene& scene, const Plan& plan);

} // namespace osculate::app
