#pragma once
/// A look at a .msh file before Gmsh's library reads it.

#include <string>

namespace osculate::mesh {

/// What is wrong, or empty. Gmsh takes files without a header for scripts, and counts in a file for what they say: so the file must
/// begin with $MeshFormat of version 2 to 2.2 or 4.1, all its sections must end, and none may announce more than it can hold.
[[nodiscard]] std::string fault_of_msh(const std::string& path);

} // namespace osculate::mesh
