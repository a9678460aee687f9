#pragma once
/// Combines facets of a surface into the element faces to which they belong, for integrals over them.

#include "osculate/mesh/mesh.hpp"

#include <vector>

namespace osculate::mesh {

/// A face of an element: a triangle, a quadrilateral, or the six-node face of a tet10, which is curved. A Facet is a
/// plane quarter of a six-node face: suitable for pictures and for neighbourhood, but not for integrals. Under uniform
/// pressure the corners of a straight six-node face get no force, and its midside nodes a third each.
struct SurfaceFace {
    /// Corners counter-clockwise seen from outside, then the midpoints of the edges 01, 12 and 20; -1 past count.
    std::array<Index, 6> nodes{-1, -1, -1, -1, -1, -1};
    int count = 0; ///< 3, 4 or 6

    /// Quarters of a six-node face that belong to the surface: those at corners 0, 1 and 2, and the middle one; a
    /// surface may contain only some of them. All true for other faces.
    std::array<bool, 4> quarters{true, true, true, true};

    [[nodiscard]] auto begin() const { return nodes.begin(); }
    [[nodiscard]] auto end() const { return nodes.begin() + count; }
    [[nodiscard]] bool whole() const { return quarters[0] && quarters[1] && quarters[2] && quarters[3]; }
};

/// The facet as a face of three or four nodes, with straight edges.
[[nodiscard]] SurfaceFace plane_face(const Facet& facet);

/// The faces to which facets of one body belong, each once, in the order of their first facets.
/// @param facets      exterior facets of `mesh`, each at most once, with nodes numbered from first_node; a facet that
///                    names no block is a face by itself
/// @param first_node  offset of the node numbers, in `facets` and in the result, from those of the mesh
/// Throws InternalError if a facet of a tet10 is not a quarter of a face of its element. O(n log n).
[[nodiscard]] std::vector<SurfaceFace> surface_faces(const Mesh& mesh, const std::vector<Facet>& facets,
                                                     Index first_node = 0);

} // namespace osculate::mesh
