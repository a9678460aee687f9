#pragma once
/// Meshes from files of every format that is read.

#include "osculate/mesh/raw_mesh.hpp"
#include "osculate/mesh/repair.hpp"

#include <filesystem>

namespace osculate::mesh {

/// Endings of the files that are read, with their dot.
[[nodiscard]] std::vector<std::string> mesh_file_endings();

/// All of a file, by the ending of its name: .vtu, .vtk (unstructured grid), .e .ex2 .exo .exii .g (Exodus), .msh (Gmsh, by its
/// library), .inp (Abaqus, CalculiX). Volume cells are tetrahedra of 4 or 10 nodes, wedges and hexahedra; lines and
/// surfaces name sets at most. Throws MeshError.
[[nodiscard]] RawMesh read_mesh_file(const std::filesystem::path& path);

/// Per cell given, the number of its connected piece, from 1, in order of their first cells. Cells are connected by nodes.
[[nodiscard]] std::vector<int> pieces_of(const RawMesh& raw, const std::vector<Index>& cells);

/// What is taken of a file.
struct MeshFileOptions {
    std::string part; ///< a named set of cells; empty: all of them
    int piece = 0;    ///< which connected piece of it, from 1, in order of their first cells; 0: all
    Repairs repairs;
};

/// The mesh of a body: the part's cells as blocks per type, nodes that it uses in the file's order, the node sets and
/// surfaces that it has a share in. Of a surface, faces within the body are left out.
/// @param mended  what was repaired, and what is suspicious but allowed, one sentence each
/// Throws MeshError with every fault found (see `Repairs`).
[[nodiscard]] Mesh make_mesh(const RawMesh& raw, const MeshFileOptions& options = {},
                             std::vector<std::string>* mended = nullptr);

} // namespace osculate::mesh
