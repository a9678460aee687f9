#pragma once
/// Checks of a mesh before anything is computed on it.

#include "osculate/mesh/mesh.hpp"

#include <span>

namespace osculate::mesh {

/// Volume of one cell within its facets, (bi)linear as they are, cubic metres; negative when the cell is turned inside out.
[[nodiscard]] double cell_volume(CellType type, std::span<const Index> nodes, const std::vector<Vec3>& positions);

/// First node of a cell, by its place in `nodes`, with a Jacobian that is not positive (NaN included), or -1.
[[nodiscard]] int bad_corner(CellType type, std::span<const Index> nodes, const std::vector<Vec3>& positions);

/// What is wrong with the mesh, one sentence each: node numbers out of range, positions that are not finite, elements
/// with a non-positive Jacobian at a node, nodes that no element uses. Empty for a sound mesh.
/// @param limit  faults listed at most; a last sentence counts the others
[[nodiscard]] std::vector<std::string> faults(const Mesh& mesh, std::size_t limit = 20);

} // namespace osculate::mesh
