#pragma once
/// Where the surface of a body is no surface: edges of more than two facets, points at which it touches itself.

#include "mesh/face_cells.hpp"

#include <utility>

namespace osculate::mesh {

struct NonManifold {
    std::vector<FaceOfCell> crowded_faces;              ///< the third and later cells at a face
    std::vector<std::pair<Index, Index>> crowded_edges; ///< of more than two exterior faces
    std::vector<Index> touching_points;                 ///< whose cells are not all connected by faces at the point
    std::vector<Index> group;                           ///< per cell and node (10 c + i): cells connected at that node
};

[[nodiscard]] NonManifold find_non_manifold(const RawMesh& raw);

/// Gives every group of cells at a touching point a point of its own; sets get all of them, faces those of their cell.
void split_non_manifold(RawMesh& raw, const NonManifold& found);

} // namespace osculate::mesh
