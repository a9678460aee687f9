#pragma once
/// Parts of a body by name or by geometry. Pure functions of a mesh and its exterior facets, which the caller extracts
/// once (exterior_facets). A facet belongs to a region when all its corners do.

#include "osculate/mesh/mesh.hpp"

#include <optional>
#include <string>
#include <vector>

namespace osculate::mesh {

/// Distance within which a node counts as being on a plane, a cylinder or a box, divided by the diagonal of the mesh's
/// bounding box. It is large enough for coordinates stored in single precision, and far below any element's size.
inline constexpr double selection_tolerance = 1e-6;

/// Nodes and exterior facets of a part of a body; empty if nothing matches.
struct Region {
    std::vector<Index> nodes;  ///< ascending, each once
    std::vector<Facet> facets; ///< oriented outward
};

/// Nodes by their numbers in the file, and the exterior facets that they cover.
[[nodiscard]] Region select_numbers(const Mesh& mesh, const std::vector<Facet>& exterior, std::vector<int> numbers);

/// The surface or node set with this name in the mesh. If both exist, the result has the surface's facets and the nodes
/// of either. A node set alone gives also the exterior facets that it covers. No value if the mesh has no such name.
[[nodiscard]] std::optional<Region> select_named(const Mesh& mesh, const std::vector<Facet>& exterior,
                                                 const std::string& name);

/// Nodes on a plane, also inside the body, and the exterior facets in it.
[[nodiscard]] Region select_plane(const Mesh& mesh, const std::vector<Facet>& exterior, const Vec3& point,
                                  const Vec3& normal);

/// Nodes at `radius` from an axis, also inside the body, and the exterior facets that follow the cylinder (not facets
/// of flat ends that only have their corners on it).
[[nodiscard]] Region select_cylinder(const Mesh& mesh, const std::vector<Facet>& exterior, const Vec3& point,
                                     const Vec3& axis, double radius);

/// Nodes inside or on an axis-parallel box, also inside the body, and the exterior facets with all corners there.
[[nodiscard]] Region select_box(const Mesh& mesh, const std::vector<Facet>& exterior, const Vec3& min, const Vec3& max);

/// Exterior facets whose outward normal is within `angle` (rad) of a direction, and their nodes.
[[nodiscard]] Region select_normal(const Mesh& mesh, const std::vector<Facet>& exterior, const Vec3& direction,
                                   double angle);

/// Named surfaces that are nearest to a point: one, or several whose facets are as near to within the tolerance, as at an edge
/// between them. A surface within another one, such as a face of a group of faces, stands for both.
/// @returns  names, ascending; none where the mesh names no surface
[[nodiscard]] std::vector<std::string> nearest_surfaces(const Mesh& mesh, const Vec3& point);

/// The node nearest to a point, on the surface or inside, or several that are as near to within the tolerance; ascending.
[[nodiscard]] std::vector<Index> nearest_nodes(const Mesh& mesh, const Vec3& point);

} // namespace osculate::mesh
