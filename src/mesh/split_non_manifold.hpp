#pragma once
/// Where the surface of a body is no surface: faces inside that do not match, edges of more than two facets, points at
/// which it touches itself.

#include "mesh/face_cells.hpp"

#include <utility>

namespace osculate::mesh {

struct NonManifold {
    std::vector<FaceOfCell> crowded_faces; ///< the third and later cells at a face
    /// Neighbours with a face of the same corners, but not of the same midside nodes.
    std::vector<std::pair<FaceOfCell, FaceOfCell>> unlike_faces;
    std::vector<std::pair<Index, Index>> crowded_edges; ///< of more than two exterior faces
    std::vector<Index> touching_points;                 ///< whose cells are not all connected by faces at the point
    std::vector<Index> group; ///< per cell and its place for a node: cells connected at that node
};

[[nodiscard]] NonManifold find_non_manifold(const RawMesh& raw);

/// Gives every group of cells at a touching point a point of its own; sets get all of them, faces those of their cell.
void split_non_manifold(RawMesh& raw, const NonManifold& found);

} // namespace osculate::mesh
