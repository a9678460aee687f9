#pragma once

namespace osculate::mesh {

/// How the top (and, extruded, every horizontal layer) of a block is divided: into quadrilaterals, into triangles, or
/// into both side by side.
enum class BlockPattern { quad, triangle, hybrid };

} // namespace osculate::mesh
