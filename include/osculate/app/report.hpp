#pragma once
/// Description of a plan in words.

#include "osculate/app/compile.hpp"

#include <string>

namespace osculate::app {

/// Number of free displacement components, in the stage that has most of them.
[[nodiscard]] Index degrees_of_freedom(const Plan& plan);

/// Parts of the plan, parts left out, and the reasons.
[[nodiscard]] std::string explain(const Plan& plan);

} // namespace osculate::app
