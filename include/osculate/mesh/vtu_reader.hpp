#pragma once

#include "osculate/mesh/mesh.hpp"

#include <filesystem>

namespace osculate::mesh {

/// Volume mesh from a VTK unstructured grid file (.vtu): tetrahedra of 4 or 10 nodes, wedges, hexahedra and voxels, one
/// block per type.
///
/// Vertex, line and surface cells are ignored, and so are points that no volume cell uses; the other points keep their
/// order. Every integer point array with one component and only values 0 and 1 becomes the node set of the same name,
/// and the exterior facets with all corners in it become the surface of that name, if there are any. The reader accepts
/// both orientations of wedges that occur in files, and stores VTK's. Throws std::runtime_error with the file and the
/// reason: unreadable file, no volume cell, another type of volume cell (its id and type), a cell without positive
/// volume (its id; ids count from 0 in the file).
[[nodiscard]] Mesh read_vtu(const std::filesystem::path& path);

} // namespace osculate::mesh
