#pragma once
/// Meshes and geometry read with Gmsh's library, which is loaded only when needed.

#include "osculate/core/types.hpp"
#include "osculate/mesh/raw_mesh.hpp"

#include <algorithm>
#include <array>
#include <string>
#include <vector>

namespace osculate::mesh {

/// Small elements around a point of a geometry. size 0: none.
struct CadFocus {
    Vec3 point = Vec3::Zero(); ///< m
    double size = 0;           ///< edge length at the point, m
    double extent = 0;         ///< distance from the point within which edges have this length, m
    double growth = 1.3;       ///< largest ratio of the lengths of an edge farther away and its inner neighbour
    bool operator==(const CadFocus&) const = default;

    /// Edge length at a distance from the point, not more than `largest`. [m]
    [[nodiscard]] double size_at(double distance, double largest) const {
        if (size <= 0) return largest;
        // edges of lengths size growth^k end at distances that are linear in their lengths
        return std::min(largest, size + (growth - 1) * std::max(0.0, distance - extent));
    }
};

/// Small elements at surfaces that meet others. size 0: none.
struct CadContact {
    double size = 0;     ///< edge length at these surfaces, m
    double growth = 1.3; ///< largest ratio of the lengths of an edge farther away and its inner neighbour
    bool operator==(const CadContact&) const = default;
};

/// Geometry to be meshed with tetrahedra.
struct CadOptions {
    std::string file;       ///< STEP or IGES, with the units of the file, or BREP, in metres
    double size = 0;        ///< largest edge length, metres; 0: a tenth of the diagonal of the geometry's box
    double smallest = 0;    ///< smallest edge length, metres
    int per_circle = 0;     ///< elements per full circle of curved faces; 0: curvature does not count
    bool quadratic = false; ///< tet10, with midside nodes on the geometry; false: tet4
    CadFocus focus{};
    CadContact contact{};
    std::vector<std::array<Vec3, 3>> meeting{}; ///< corners of triangles of those surfaces, m
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
