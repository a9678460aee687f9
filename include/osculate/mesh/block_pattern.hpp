#pragma once

#include "osculate/mesh/cell_type.hpp"

namespace osculate::mesh {

/// How the top of a block (and, by extrusion, every horizontal layer) is divided: into quadrilaterals, into triangles,
/// or into both side by side.
enum class BlockPattern { quad, triangle, hybrid };

/// Whether columns of these elements can be cut otherwise than as quad says.
[[nodiscard]] constexpr bool has_patterns(CellType element) {
    return element == CellType::hex8 || is_wedge(element);
}

} // namespace osculate::mesh
