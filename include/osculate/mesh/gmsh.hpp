#pragma once
/// Meshes and geometry by Gmsh's library, which stays unloaded until it is asked for.

#include "osculate/mesh/raw_mesh.hpp"

#include <string>

namespace osculate::mesh {

/// Geometry to be meshed with tetrahedra.
struct CadOptions {
    std::string file;       ///< STEP or IGES, whose own units count, or BREP, in metres
    double size = 0;        ///< largest edge length, metres; 0: a tenth of the diagonal of the geometry's box
    double smallest = 0;    ///< smallest edge length, metres
    int per_circle = 0;     ///< elements per full circle of curved faces; 0: curvature does not count
    bool quadratic = false; ///< tet10, with midside nodes on the geometry; false: tet4
    bool operator==(const CadOptions&) const = default;
};

/// A .msh file, version 2.2 or 4.1, text or binary: physical groups of volumes are parts, those of surfaces are surfaces,
/// those of curves and points node sets, by their names or physical_<tag>; elementary volumes are parts volume_<tag>.
/// Throws MeshError; where the library is not installed, it names the package.
[[nodiscard]] RawMesh read_gmsh(const std::string& path);

/// A mesh of the geometry in metres; surfaces face_<tag>, parts volume_<tag>, and names that the file brings along.
/// The same input gives the same bits. Throws MeshError.
[[nodiscard]] RawMesh mesh_cad(const CadOptions& options);

} // namespace osculate::mesh
