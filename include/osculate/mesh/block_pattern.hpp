#pragma once

namespace osculate::mesh {

/// How the top of a block (and, by extrusion, every horizontal layer) is divided: into quadrilaterals, into triangles,
/// or into both side by side.
enum class BlockPattern { quad, triangle, hybrid };

} // namespace osculate::mesh
