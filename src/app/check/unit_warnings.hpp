#pragma once
/// Values of a scene that look wrong by powers of ten.

#include "app/check/warning.hpp"
#include "osculate/app/compile.hpp"

#include <vector>

namespace osculate::app {

[[nodiscard]] std::vector<Warning> unit_warnings(const scene::Scene& scene, const Plan& plan);

} // namespace osculate::app
