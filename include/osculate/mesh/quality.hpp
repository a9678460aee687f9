#pragma once
/// Checks of a mesh before any computation.

#include "osculate/mesh/mesh.hpp"

#include <span>

namespace osculate::mesh {

/// Volume of one cell bounded by its (bi)linear facets, cubic metres; negative if the cell is inside out.
[[nodiscard]] double cell_volume(CellType type, std::span<const Index> nodes, const std::vector<Vec3>& positions);

/// First corner of a cell, or node of a tet10, as index into `nodes`, at which the Jacobian is not positive (or is NaN);
/// -1 if there is none. Shape functions tell of other places: fe::bad_jacobians.
[[nodiscard]] int bad_corner(CellType type, std::span<const Index> nodes, const std::vector<Vec3>& positions);

/// Faults of the mesh, one sentence each: node numbers out of range, positions that are not finite, elements with a
/// Jacobian that bad_corner finds not positive, nodes that no element uses. Empty for a correct mesh.
/// @param limit  largest number of faults listed; a last sentence gives the number of the others
[[nodiscard]] std::vector<std::string> faults(const Mesh& mesh, std::size_t limit = 20);

} // namespace osculate::mesh
