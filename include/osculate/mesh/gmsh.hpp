#pragma once
/// Meshes and geometry read with Gmsh's library, which is loaded only when needed.

#include "osculate/mesh/raw_mesh.hpp"

#include <string>

namespace osculate::mesh {

/// Geometry to be meshed with tetrahedra.
struct CadOptions {
    std::string file;       ///< STEP or IGES, with the units of the file, or BREP, in metres
    double size = 0;        ///< largest edge length, metres; 0: a tenth of the diagonal of the geometry's box
    double smallest = 0;    ///< smallest edge length, metres
    int per_circle = 0;     ///< elements per full circle of curved faces; 0: curvature does not count
    bool quadratic = false; ///< tet10, with midside nodes on the geometry; false: tet4
    bool operator==(const CadOptions&) const = default;
};

/// Reads a .msh file, version 2.2 or 4.1, text or binary. Physical groups of volumes become parts, those of surfaces
/// become surfaces, those of curves and points become node sets, with their names or physical_<tag>; elementary volumes
/// become parts volume_<tag>. Throws MeshError; if the library is not installed, the message names the package.
[[nodiscard]] RawMesh read_gmsh(const std::string& path);

/// A mesh of the geometry in metres; surfaces face_<tag>, parts volume_<tag>, and names from the file. The same input
/// gives bitwise the same mesh. Throws MeshError.
[[nodiscard]] RawMesh mesh_cad(const CadOptions& options);

} // namespace osculate::mesh
