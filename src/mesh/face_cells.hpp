#pragma once
/// Which cells share a face.

#include "osculate/mesh/raw_mesh.hpp"

namespace osculate::mesh {

/// A face by its corners in ascending order; nodes[3] is -1 for a triangle.
struct FaceOfCell {
    std::array<Index, 4> corners{-1, -1, -1, -1};
    Index cell = -1;
    int face = -1; ///< of CellInfo::faces
};

/// All faces of all cells, those of the same corners side by side, in ascending order of corners. O(n) for meshes whose
/// nodes have a bounded number of cells.
[[nodiscard]] std::vector<FaceOfCell> faces_side_by_side(const std::vector<RawCell>& cells, std::size_t point_count);

} // namespace osculate::mesh
