#pragma once
/// The mesh in an input deck of Abaqus or CalculiX.

#include "osculate/mesh/deck.hpp"
#include "osculate/mesh/raw_mesh.hpp"

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace osculate::mesh {

/// What a layer of elements stands for whose deck has plane elements.
enum class DeckSlice : char { none, plane_strain, plane_stress, axisymmetric };

/// A mesh with additional data of its deck. Names in capitals are keys, because decks do not distinguish upper and
/// lower case.
struct DeckMesh {
    RawMesh raw;
    std::vector<std::string> types;                                       ///< C3D8, ...; of every cell
    std::vector<char> type;                                               ///< per cell, index into `types`
    std::map<std::string, std::string> node_set_names, element_set_names; ///< key -> as first written, as in `raw`
    std::map<std::string, std::string> surface_names;

    /// Per cell; empty where no cell is plane. A plane element becomes one layer of solid elements above it along z, as thick
    /// as its section says, or within `sector_angle` about y. Its sides are the faces S1 to S4.
    std::vector<DeckSlice> slices;
    std::map<Index, std::vector<Index>> above; ///< points of the layer over a point of a plane element
    /// Degrees. CalculiX takes 2; chords and arcs of midside nodes then differ by 1.5e-4 of the radius, which is felt in contact.
    static constexpr double sector_angle = 0.5;
    /// Radius to which points on the axis of CAX elements are moved, of the diagonal of the mesh: so layers have a face along the
    /// axis, and their points are told apart. What is missing of the volume is a millionth.
    static constexpr double bore = 1e-3;
    Index bored = 0; ///< points that were moved so

    /// Per cell, whether it is the layer behind a rigid facet; empty where none is.
    std::vector<char> shells;
    [[nodiscard]] bool is_shell(Index cell) const {
        return static_cast<std::size_t>(cell) < shells.size() && shells[static_cast<std::size_t>(cell)] != 0;
    }

    /// Face of a cell, as deck_face() but for plane elements; rigid facets have none of these numbers.
    [[nodiscard]] RawFace face_of(Index cell, int face) const;
    /// The side of a rigid facet that bodies may touch.
    [[nodiscard]] RawFace front_of(Index cell) const;
    /// Cell or point with a given number in the deck, -1 if there is none.
    [[nodiscard]] Index cell(long long id) const;
    [[nodiscard]] Index point(long long id) const;
    std::vector<std::pair<long long, Index>> cell_order, point_order; ///< ascending
};

/// Reads *NODE, *ELEMENT of types R3D3, R3D4 (rigid facets, which get a layer of solid elements behind them), C3D4, C3D6, C3D8, C3D8I, C3D8R, C3D10, C3D20, C3D20R, and of CPE, CPS and CAX with 3, 4, 6
/// or 8 nodes, *NSET, *ELSET (GENERATE; a set may name
/// others) and *SURFACE of faces S1 to S6, of whole element sets (their exterior faces) and of nodes. Ignores other
/// keywords. Element sets become parts, surfaces of nodes become node sets. Throws MeshError with all faults, each with
/// file and line.
[[nodiscard]] DeckMesh read_deck_mesh(const Deck& deck);
[[nodiscard]] DeckMesh read_deck_mesh(const std::filesystem::path& path);

/// Corner nodes of face S1 to S6 (0 to 5) of a cell, for C3D10 also the midside nodes; count 0 if there is no such
/// face.
[[nodiscard]] RawFace deck_face(const RawCell& cell, int face);

} // namespace osculate::mesh
