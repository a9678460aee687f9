#pragma once
/// Faces and corners of the cell types, in VTK's node order.

#include "osculate/mesh/mesh.hpp"

#include <span>

namespace osculate::mesh {

/// Local node numbers of a face, or of one of the four triangles of a six-node face, counter-clockwise seen from outside;
/// nodes[3] is -1 for a triangle.
struct LocalFace {
    std::array<int, 4> nodes;
    int count;
};

[[nodiscard]] std::span<const LocalFace> cell_faces(CellType type);

/// Local node numbers of the three neighbours of every corner, ordered so that the triple product of the edges to them
/// is positive in a well-shaped element. A tetrahedron's Jacobian is constant: one corner stands for all. None for tet10,
/// whose edges are curved.
[[nodiscard]] std::span<const std::array<int, 3>> corner_neighbours(CellType type);

} // namespace osculate::mesh
