#pragma once
/// Trees as text.

#include "scene/tree.hpp"

#include <string>

namespace osculate::scene {

/// A tree as one line of YAML.
[[nodiscard]] std::string flow_text(const Tree& tree);

/// "{blend: {ring: 3}}" -> "blend-ring-3": a name made of letters, digits, _, - and .
[[nodiscard]] std::string name_of_value(const std::string& text);

} // namespace osculate::scene
