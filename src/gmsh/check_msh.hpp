#pragma once
/// A look at a whole .msh file before Gmsh's library reads it.

#include <string>

namespace osculate::mesh {

/// What Gmsh's library may read of a file: $MeshFormat (2 to 2.2 or 4.1), $PhysicalNames, $Entities, $Nodes and $Elements, every
/// number of which has been looked at: counts hold, types and dimensions are known, nodes and entities that are referred to
/// exist. The library looks little of this up: it takes files without a header for scripts, allocates what a count asks for
/// and writes past its arrays. Other sections are left out, as nothing of them is used.
/// Throws MeshError with the line, or the byte of a binary file.
[[nodiscard]] std::string checked_msh(const std::string& path);

} // namespace osculate::mesh
