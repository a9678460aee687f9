#pragma once
/// Types of elements in decks. Their faces are in deck_elements.cpp, too: `deck_face` of deck_mesh.hpp.

#include "osculate/mesh/mesh.hpp"

#include <array>
#include <string>
#include <string_view>

namespace osculate::mesh {

struct DeckElementType {
    std::string_view name; ///< in capitals
    CellType cell;
    std::array<int, 10> nodes; ///< place of every node of ours among the deck's
};

/// Type of a name in capitals, nullptr for one that is not read.
[[nodiscard]] const DeckElementType* deck_element_type(std::string_view name);

/// Names of all types, for messages.
[[nodiscard]] std::string deck_element_names();

} // namespace osculate::mesh
