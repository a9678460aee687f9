#pragma once
/// Meshes from files of all supported formats.

#include "osculate/mesh/raw_mesh.hpp"
#include "osculate/mesh/repair.hpp"

#include <filesystem>

namespace osculate::mesh {

/// Extensions of the supported files, with their dot.
[[nodiscard]] std::vector<std::string> mesh_file_endings();

/// Reads a whole file, according to the extension of its name: .vtu, .vtk (unstructured grid), .e .ex2 .exo .exii .g
/// (Exodus), .msh (Gmsh, with its library), .inp (Abaqus, CalculiX). Volume cells are tetrahedra of 4 or 10 nodes,
/// wedges and hexahedra; lines and surfaces only define sets. Throws MeshError.
[[nodiscard]] RawMesh read_mesh_file(const std::filesystem::path& path);

/// For each given cell, the number of its connected piece, from 1, in the order of their first cells. Cells that share
/// a node are connected.
[[nodiscard]] std::vector<int> pieces_of(const RawMesh& raw, const std::vector<Index>& cells);

/// Which part of a file to use.
struct MeshFileOptions {
    std::string part; ///< a named set of cells; empty: all of them
    int piece = 0;    ///< which connected piece of it, from 1, in the order of their first cells; 0: all
    Repairs repairs;
    std::vector<std::string>
        sections{}; ///< named sets of cells that get blocks of their own; the last that has a cell counts
};

/// The mesh of a body: the part's cells in blocks per type, the nodes that they use in the file's order, and those node
/// sets and surfaces that contain nodes or faces of the part. Faces of a surface that are inside the body are left out.
/// @param mended  what was repaired, and what is suspicious but allowed, one sentence each
/// Throws MeshError with every fault found (see `Repairs`).
[[nodiscard]] Mesh make_mesh(const RawMesh& raw, const MeshFileOptions& options = {},
                             std::vector<std::string>* mended = nullptr);

} // namespace osculate::mesh
