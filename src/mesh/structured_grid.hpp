#pragma once
/// A curved i-j-k grid of hexahedra, and the one routine that turns it into any element type.

#include "osculate/mesh/block_pattern.hpp"
#include "osculate/mesh/mesh.hpp"

#include <functional>

namespace osculate::mesh {

struct StructuredGrid {
    std::array<int, 3> divisions{1, 1, 1};       ///< between nodes: one per element, two where edges have midside nodes
    std::array<const char*, 6> sides{};          ///< surface names of i_min, i_max, j_min, j_max, k_min, k_max
    std::function<Vec3(int, int, int)> position; ///< of node (i, j, k), metres; (i, j, k) is right-handed
};

/// Divisions of the grid that gives so many elements. Throws std::invalid_argument for numbers past any mesh.
[[nodiscard]] std::array<int, 3> grid_divisions(std::array<int, 3> elements, CellType element);

/// Mesh of the grid with every side as a named surface; nodes numbered with i fastest, k slowest.
/// Columns along k are cut into wedges as the pattern says. Throws std::invalid_argument for an empty grid, for one with
/// more nodes than Index can number, for an element that is none of generated_types(), and for a pattern that it does
/// not have.
[[nodiscard]] Mesh mesh_grid(const StructuredGrid& grid, CellType element, BlockPattern pattern);

} // namespace osculate::mesh
