#pragma once
/// Surfaces of a deck.

#include "mesh/deck/sets.hpp"
#include "osculate/mesh/deck_mesh.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace osculate::mesh {

/// *SURFACE: faces of elements into the mesh, nodes as a set of nodes.
class DeckSurfaces {
public:
    /// @param mesh  has its nodes and elements
    DeckSurfaces(DeckReading& reading, DeckMesh& mesh, DeckSets& node_sets, const DeckSets& element_sets)
        : reading_(reading), mesh_(mesh), node_sets_(node_sets), element_sets_(element_sets) {}

    void read(const DeckCard& card);

private:
    void read_faces(const DeckCard& card, const std::string& name);
    void read_nodes(const DeckCard& card, const std::string& name);
    /// The element or the set of elements that a line begins with.
    [[nodiscard]] std::vector<Index> cells_of_line() const;
    void add_face(const DeckLine& line, const std::vector<Index>& cells, std::vector<RawFace>& faces);
    /// Faces of these cells that no cell of the deck has on the other side.
    void add_outside(const std::vector<Index>& cells, std::vector<RawFace>& faces);

    DeckReading& reading_;
    DeckMesh& mesh_;
    DeckSets& node_sets_;
    const DeckSets& element_sets_;
    std::vector<std::string_view> fields_;   ///< of the line that is read
    std::vector<std::vector<int>> exterior_; ///< per cell; empty until they are asked for
};

} // namespace osculate::mesh
