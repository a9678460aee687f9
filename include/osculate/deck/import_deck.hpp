#pragma once
/// Scenes from input decks of Abaqus and CalculiX.

#include "osculate/mesh/deck.hpp"

#include <string>
#include <vector>

namespace osculate::deck {

/// Units that the numbers of a deck are in.
enum class DeckUnits {
    si, ///< m, kg, s
    mm, ///< mm, t, s; so N and MPa
};

struct ImportedScene {
    std::string text;                  ///< YAML, with comments
    std::vector<std::string> left_out; ///< `file:line: what: why`, in order: `lost` and `notes` together
    std::vector<std::string> lost;     ///< of these, loads, contact, materials, supports and steps that the scene lacks
    std::vector<std::string> notes; ///< of these, the others: output, solver settings, what means something else here
};

/// The deck as a scene: a body per connected piece of its mesh, which is read from the deck itself, loads and supports by steps,
/// contact pairs, materials. What is lost, and what has another meaning, is listed in comments too.
/// @param mesh_path  of the deck, as the scene is to name it
/// Throws mesh::MeshError where the deck has no mesh fit for use, or no step that can be run.
[[nodiscard]] ImportedScene import_deck(const mesh::Deck& deck, const std::string& mesh_path, DeckUnits units);

} // namespace osculate::deck
