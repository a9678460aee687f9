#pragma once
/// Schema of studies of runs, whose reader takes formulas and free maps that `describe` has no words for.

#include "scene/schema_visitor.hpp"

namespace osculate::scene {

[[nodiscard]] Json run_study_schema();

} // namespace osculate::scene
