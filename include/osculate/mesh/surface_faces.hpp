#pragma once
/// Facets of a surface put together to the element faces that they are parts of, for integrals over them.

#include "osculate/mesh/mesh.hpp"

#include <vector>

namespace osculate::mesh {

/// A face of an element: a triangle, a quadrilateral, or the face of a tet10, which is curved with its six nodes. A Facet is
/// a plane quarter of the latter: good for pictures and for who is next to whom, not for integrals. Under a uniform pressure
/// the corners of a straight six-node face carry nothing and its middle nodes a third each.
struct SurfaceFace {
    /// Corners counter-clockwise seen from outside, then the nodes midway on the edges 01, 12 and 20; -1 past count.
    std::array<Index, 6> nodes{-1, -1, -1, -1, -1, -1};
    int count = 0; ///< 3, 4 or 6

    /// Quarters of a six-node face: those at corners 0, 1 and 2, and the middle one; part of a surface may be cut through
    /// a face. All of it otherwise.
    std::array<bool, 4> quarters{true, true, true, true};

    [[nodiscard]] auto begin() const { return nodes.begin(); }
    [[nodiscard]] auto end() const { return nodes.begin() + count; }
    [[nodiscard]] bool whole() const { return quarters[0] && quarters[1] && quarters[2] && quarters[3]; }
};

/// The facet as a face of three or four nodes, with straight edges.
[[nodiscard]] SurfaceFace plane_face(const Facet& facet);

/// The faces that facets of one body are parts of, each once, in the order of their first facets.
/// @param facets      exterior facets of `mesh`, each at most once, their nodes numbered from first_node; those that name
///                    no block are faces by themselves
/// @param first_node  added to the mesh's node numbers in what comes back, as it is in `facets`
/// Throws InternalError where a facet of a tet10 is no quarter of one of its element's faces. O(n log n).
[[nodiscard]] std::vector<SurfaceFace> surface_faces(const Mesh& mesh, const std::vector<Facet>& facets,
                                                     Index first_node = 0);

} // namespace osculate::mesh
