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

/// Local node numbers of face 0 to 3 of a tet10, whose quarters are cell_faces 4 face to 4 face + 3: corners, then the
/// nodes midway on the edges 01, 12 and 20.
[[nodiscard]] std::array<int, 6> six_node_face(std::size_t face);

/// Local node numbers of the three neighbours of every corner, ordered so that the triple product of the edges to them
/// is positive in a well-shaped element. A tetrahedron's Jacobian is constant: one corner stands for all. None for tet10,
/// whose edges are curved.
[[nodiscard]] std::span<const std::array<int, 3>> corner_neighbours(CellType type);

} // namespace osculate::mesh
