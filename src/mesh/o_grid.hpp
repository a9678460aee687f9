#pragma once
/// A core of hexahedra with layers of hexahedra grown outward from some of its sides: balls and cylinders without an axis
/// where elements degenerate.

#include "osculate/mesh/mesh.hpp"

#include <functional>

namespace osculate::mesh {

struct OGrid {
    std::array<int, 3> core{1, 1, 1};   ///< elements of the core along i, j, k
    int layers = 1;                     ///< elements from the core to the outer surface
    std::array<bool, 6> grown{};        ///< sides with layers: i_min, i_max, j_min, j_max, k_min, k_max
    std::array<const char*, 6> sides{}; ///< surface names of the sides without; the outermost is "outer"
    /// Of node (i, j, k) of the core in layer l, metres; (i, j, k) is right-handed. l > 0 on grown sides only.
    std::function<Vec3(int i, int j, int k, int l)> position;
};

/// Throws std::invalid_argument for an empty grid and for one with more nodes than Index can number.
[[nodiscard]] Mesh mesh_o_grid(const OGrid& grid);

} // namespace osculate::mesh
