#pragma once
/// The mesh in an input deck of Abaqus or CalculiX.

#include "osculate/mesh/deck.hpp"
#include "osculate/mesh/raw_mesh.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace osculate::mesh {

/// A mesh with what its deck says beside: names in capitals are keys, as decks do not tell cases apart.
struct DeckMesh {
    RawMesh raw;
    std::vector<std::string> types;                                       ///< C3D8, ...; of every cell
    std::vector<char> type;                                               ///< per cell, of `types`
    std::map<std::string, std::string> node_set_names, element_set_names; ///< key -> as first written, as in `raw`
    std::map<std::string, std::string> surface_names;

    /// Cell or point of a number of the deck, -1 where there is none.
    [[nodiscard]] Index cell(long long id) const;
    [[nodiscard]] Index point(long long id) const;
    std::vector<std::pair<long long, Index>> cell_order, point_order; ///< ascending
};

/// *NODE, *ELEMENT of types C3D4, C3D6, C3D8, C3D8I, C3D8R, C3D10, *NSET, *ELSET (GENERATE; names in names), *SURFACE of
/// faces S1 to S6, of whole sets of elements (their faces at the outside) and of nodes. Other keywords are passed over.
/// Element sets are parts, surfaces of nodes are node sets. Throws MeshError with all that is wrong, file and line.
[[nodiscard]] DeckMesh read_deck_mesh(const Deck& deck);
[[nodiscard]] DeckMesh read_deck_mesh(const std::filesystem::path& path);

/// Corner nodes of face S1 to S6 (0 to 5) of a cell, with those midway for C3D10; count 0 where it has no such face.
[[nodiscard]] RawFace deck_face(const RawCell& cell, int face);

} // namespace osculate::mesh
