#pragma once
/// Rigid facets of decks as a layer of solid elements.

#include "mesh/deck/reading.hpp"
#include "mesh/deck/sets.hpp"
#include "osculate/mesh/deck_mesh.hpp"

#include <string_view>
#include <vector>

namespace osculate::mesh {

/// R3D3 and R3D4. Their nodes are the front of the layer, which is as thick as a fraction of the shortest edge at a node, and behind
/// the side that surfaces name.
class DeckShells {
public:
    DeckShells(DeckReading& reading, DeckMesh& mesh) : reading_(reading), mesh_(mesh) {}

    /// Nodes of an element of a type in capitals; 0: it is no rigid facet.
    [[nodiscard]] static int nodes_of(std::string_view type);

    /// A cell whose back is missing; it is the next of the mesh.
    [[nodiscard]] RawCell begin(const DeckLine& line, const std::vector<Index>& points);
    /// Makes the backs of all.
    void finish(const DeckSets& element_sets);

private:
    static constexpr double thickness = 0.25; ///< of the shortest edge at a node

    struct Shell {
        Index cell;
        const DeckLine* line;
        std::vector<Index> points;
        bool front = false, back = false; ///< sides that surfaces name: SPOS, SNEG
    };
    void find_sides(const DeckSets& element_sets);
    [[nodiscard]] std::vector<Index> backs();

    DeckReading& reading_;
    DeckMesh& mesh_;
    std::vector<Shell> shells_;
};

} // namespace osculate::mesh
