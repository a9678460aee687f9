#pragma once
/// Combines facets of a surface into the element faces to which they belong, for integrals over them.

#include "osculate/mesh/mesh.hpp"

#include <vector>

namespace osculate::mesh {

/// A face of an element, with straight or curved edges. A Facet is a plane piece of a face with midside nodes: suitable
/// for pictures and for neighbourhood, but not for integrals. Under uniform pressure the corners of a straight six-node
/// face get no force, and its midside nodes a third each.
struct SurfaceFace {
    std::array<Index, most_nodes_per_face> nodes{-1, -1, -1, -1, -1, -1, -1, -1}; ///< as FaceShape; -1 past count
    int count = 0;
    /// Which pieces of its shape belong to the surface; a surface may contain only some of them.
    std::array<bool, most_pieces_per_face> pieces{true, true, true, true, true};

    [[nodiscard]] auto begin() const { return nodes.begin(); }
    [[nodiscard]] auto end() const { return nodes.begin() + count; }
    [[nodiscard]] const FaceShape& shape() const { return face_shape(count); }
    [[nodiscard]] bool whole() const {
        for (std::size_t piece = 0; piece < shape().pieces.size(); ++piece)
            if (!pieces[piece]) return false;
        return true;
    }
};

/// The facet as a face of three or four nodes, with straight edges.
[[nodiscard]] SurfaceFace plane_face(const Facet& facet);

/// The faces to which facets of one body belong, each once, in the order of their first facets.
/// @param facets      exterior facets of `mesh`, each at most once, with nodes numbered from first_node; a facet that
///                    names no block is a face by itself
/// @param first_node  offset of the node numbers, in `facets` and in the result, from those of the mesh
/// Throws InternalError if a facet of a quadratic element is not a piece of a face of it. O(n log n).
[[nodiscard]] std::vector<SurfaceFace> surface_faces(const Mesh& mesh, const std::vector<Facet>& facets,
                                                     Index first_node = 0);

} // namespace osculate::mesh
