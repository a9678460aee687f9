#pragma once

#include "osculate/mesh/mesh.hpp"

#include <filesystem>

namespace osculate::mesh {

/// Volume mesh from a VTK unstructured grid file (.vtu): tetrahedra of 4 or 10 nodes, wedges, hexahedra and voxels, a block per type.
///
/// Vertex, line and surface cells are ignored, and so are points that no volume cell uses; the others keep their order.
/// Every integer point array with one component and no value but 0 and 1 becomes the node set of the same name, and the
/// exterior facets with all corners in it become the surface of that name, if there are any.
/// Wedges are taken in either of the two orientations found in files, and stored in VTK's.
/// Throws std::runtime_error with the file and the reason: unreadable file, no volume cell, another type of volume cell
/// (its id and type), a cell without positive volume (its id; ids count from 0 in the file).
[[nodiscard]] Mesh read_vtu(const std::filesystem::path& path);

} // namespace osculate::mesh
