#pragma once
/// Scenes from input decks of Abaqus and CalculiX.

#include "osculate/mesh/deck.hpp"

#include <string>
#include <vector>

namespace osculate::deck {

/// Units of the numbers in a deck.
enum class DeckUnits {
    si, ///< m, kg, s
    mm, ///< mm, t, s; so N and MPa
};

struct ImportedScene {
    std::string text;                  ///< YAML, with comments
    std::vector<std::string> left_out; ///< `file:line: what: why`, in order: `lost` and `notes` together
    std::vector<std::string> lost;     ///< of these: loads, contact, materials, supports and steps missing in the scene
    std::vector<std::string> notes;    ///< of these: all others, such as output, solver settings, changed meanings
};

/// Converts a deck to a scene: one body per connected piece of its mesh, which is read from the deck itself, loads and
/// supports by steps, contact pairs, materials. Lost features, and those with another meaning, are also listed in
/// comments.
/// @param mesh_path  path of the deck as written in the scene
/// Throws mesh::MeshError if the deck has no usable mesh, or no step that can be run.
[[nodiscard]] ImportedScene import_deck(const mesh::Deck& deck, const std::string& mesh_path, DeckUnits units);

} // namespace osculate::deck
