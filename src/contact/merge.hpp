#pragma once
/// Surfaces whose near-duplicate nodes are merged.

#include "osculate/mesh/half_edge_surface.hpp"

#include <memory>
#include <vector>

namespace osculate::contact {

/// A surface without its near-duplicate vertices. Of vertices that share a facet and are closer than 0.01 of the mean
/// distance between nearest nodes around them the lowest is kept; facets that vanish with the others are left out,
/// quadrilaterals that lose a corner become triangles.
struct MergedSurface {
    mesh::HalfEdgeSurface topology;
    std::vector<Index> vertex; ///< vertex of the original surface that each vertex is, ascending
    std::vector<Index> host; ///< facet for every original one: what became of it, or one that holds what is left of it
    std::vector<Vec3> X;     ///< of the vertices, m
};

/// @param X     reference positions of the surface's vertices
/// @param ring  rings of facets around a vertex over which distances between nodes are averaged
/// @returns null where there is nothing to merge, or where merging would join more than two facets in one edge.
///          Cost: one comparison an edge, where no edge is much shorter than others.
[[nodiscard]] std::unique_ptr<MergedSurface> merged(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X,
                                                    int ring);

} // namespace osculate::contact
