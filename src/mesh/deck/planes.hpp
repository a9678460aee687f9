#pragma once
/// Plane elements of decks as layers of solid ones.

#include "mesh/deck/numbers.hpp"
#include "mesh/deck/reading.hpp"
#include "osculate/mesh/deck_mesh.hpp"

#include <optional>

namespace osculate::mesh {

/// A type of plane elements.
struct PlaneType {
    DeckSlice slice = DeckSlice::none;
    int nodes = 0; ///< of an element in the deck: 3, 4 or 8
    CellType solid = CellType::hex8;
};

/// Of a name in capitals: CPE, CPS or CAX, 3, 4 or 8, and maybe R.
[[nodiscard]] std::optional<PlaneType> deck_plane_type(std::string_view name);

/// Makes the points of layers.
class DeckPlanes {
public:
    DeckPlanes(DeckReading& reading, DeckMesh& mesh);

    /// Thickness of the elements of a card; 0, and a fault, where sections do not tell.
    double thickness(const DeckCard& card);
    [[nodiscard]] bool lie_in_plane(const std::vector<Index>& points) const;
    /// A solid element of an element in the plane, whose points are in the order of the deck.
    RawCell layer(const PlaneType& type, const std::vector<Index>& points, double thickness);

private:
    /// Moves points that are on the axis off it, see DeckMesh::bore.
    void leave_axis(const std::vector<Index>& points);
    /// Point over another, at a share of the layer, 0.5 or 1.
    Index above(Index point, const PlaneType& type, double thickness, double share);

    DeckReading& reading_;
    DeckMesh& mesh_;
    double bore_ = 0;                      ///< radius, m; 0 until it is asked for
    std::map<std::string, double> of_set_; ///< thickness by names of element sets, in capitals
    std::map<std::tuple<Index, DeckSlice, double, double>, Index> made_;
};

} // namespace osculate::mesh
