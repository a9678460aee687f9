#pragma once
/// Faces of a surface, between its feature edges.

#include "osculate/mesh/half_edge_surface.hpp"

#include <vector>

namespace osculate::app {

/// Smooth parts of a surface, between feature edges.
struct SmoothParts {
    bool plane = true;   ///< all of them
    bool strips = false; ///< one is curved and nowhere wider than a facet: patches tell nothing about its slope across
};

/// @param X  reference positions of all nodes, m
[[nodiscard]] SmoothParts smooth_parts(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X);

} // namespace osculate::app
