#pragma once
/// Meshes of triangles and quadrilaterals whose nodes are on an exact surface.

#include "osculate/mesh/mesh.hpp"
#include "osculate/study/approximation.hpp"
#include "osculate/study/exact_surface.hpp"

namespace osculate::study {

/// Lifts a mesh of the x1x2 plane onto the surface: onto the upper half of a sphere, the upper outer half of a torus.
/// Facets must be counter-clockwise, seen from above.
/// Throws std::runtime_error if a node is not below the surface.
[[nodiscard]] SurfaceMesh lift(const std::vector<Vec2>& plane, std::vector<mesh::Facet> facets,
                               const ExactSurface& exact);

/// Hybrid mesh: a closed sphere (n x n per side of a cube) or torus (2n along the ring, n around the tube); for the
/// saddle, the part above a square of edge 2 m about its centre (n x n).
/// @param n             at least 3
/// @param irregularity  largest displacement of the nodes along the surface, in edge lengths; below 0.25. Nodes on the
///                      saddle's boundary do not move.
[[nodiscard]] SurfaceMesh refined_mesh(const ExactSurface& exact, int n, double irregularity);

} // namespace osculate::study
