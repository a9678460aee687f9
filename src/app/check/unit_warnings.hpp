#pragma once
/// Values of a scene that look wrong by powers of ten.

#include "osculate/app/compile.hpp"

#include <string>
#include <vector>

namespace osculate::app {

struct Warning {
    std::string key;  ///< of the scene
    std::string text; ///< what stands there, and what is odd about it
};

/// None of these is a fault: every one may be meant.
[[nodiscard]] std::vector<Warning> unit_warnings(const scene::Scene& scene, const Plan& plan);

} // namespace osculate::app
