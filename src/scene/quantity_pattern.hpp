#pragma once
/// Regular expressions of quantities, for editors that know nothing else of units.

#include "scene/visitor.hpp"

#include <string>

namespace osculate::scene {

/// Of a unit of this dimension: single units and products of two exactly, of three or more whatever comes out; a plain
/// number's is empty.
[[nodiscard]] std::string unit_pattern(Dimension dimension);

/// Of a text that is a number with or without a unit of the key's dimension, of the sign that its range allows. Other
/// bounds cannot be seen in a text.
[[nodiscard]] std::string quantity_pattern(const Key& key);

} // namespace osculate::scene
