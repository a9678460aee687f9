#pragma once
/// Supports that hold nothing, and loads on what is held.

#include "app/check/warning.hpp"
#include "osculate/app/compile.hpp"
#include "osculate/scene/scene.hpp"

#include <vector>

namespace osculate::app {

/// Of supports without a component held at zero, on sets that no stage moves; and see held_loads().
[[nodiscard]] std::vector<Warning> support_warnings(const scene::Scene& scene, const Plan& plan);

} // namespace osculate::app
