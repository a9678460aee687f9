#pragma once
/// JSON Schema (draft 7) of a scene, a study or an output template, for editors.

#include <string>
#include <vector>

namespace osculate::scene {

/// Types, units, bounds, words, choices, required keys, meanings and defaults of every key, from the same description
/// that reader and writer use. Not included: names that refer to others, bounds of texts with units, and rules across
/// keys.
[[nodiscard]] std::string scene_schema();
[[nodiscard]] std::string template_schema();
/// For studies of runs and of surfaces.
/// @param methods  approximations of surfaces that a study may list
[[nodiscard]] std::string study_schema(const std::vector<std::string>& methods);

} // namespace osculate::scene
