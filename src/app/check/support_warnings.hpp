#pragma once
/// Supports that hold nothing.

#include "app/check/warning.hpp"
#include "osculate/scene/scene.hpp"

#include <vector>

namespace osculate::app {

/// Of supports without a component held at zero, on sets that no stage moves.
[[nodiscard]] std::vector<Warning> support_warnings(const scene::Scene& scene);

} // namespace osculate::app
