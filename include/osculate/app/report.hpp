#pragma once
/// What a plan holds, in words.

#include "osculate/app/compile.hpp"

#include <string>

namespace osculate::app {

/// Free displacement components, at the stage that has most of them.
[[nodiscard]] Index degrees_of_freedom(const Plan& plan);

/// What the plan contains, what it leaves out and why.
[[nodiscard]] std::string explain(const Plan& plan);

} // namespace osculate::app
