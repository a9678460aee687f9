#pragma once
/// Types of elements by their names in decks, and faces by their numbers there.

#include "osculate/mesh/mesh.hpp"

#include <string>
#include <string_view>

namespace osculate::mesh {

/// Type of a name in capitals, nullptr for one that is not read.
[[nodiscard]] const CellInfo* deck_element_type(std::string_view name);

/// Names of all types, for messages.
[[nodiscard]] std::string deck_element_names();

} // namespace osculate::mesh
