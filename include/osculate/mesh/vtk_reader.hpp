#pragma once
/// Meshes of files that VTK reads; its readers are loaded only when needed.

#include "osculate/mesh/raw_mesh.hpp"

#include <filesystem>

namespace osculate::mesh {

/// Unstructured grids, .vtu and legacy .vtk; points and cells count from 0. Throws MeshError.
[[nodiscard]] RawMesh read_vtu_cells(const std::filesystem::path& path);
[[nodiscard]] RawMesh read_vtk_cells(const std::filesystem::path& path);

/// Exodus II: element blocks as parts, node sets, side sets as surfaces, by their names, or block_<id>, node_set_<id> and
/// side_set_<id>; nodes and elements count from 1, blocks in the file's order. Throws MeshError.
[[nodiscard]] RawMesh read_exodus_cells(const std::filesystem::path& path);

} // namespace osculate::mesh
