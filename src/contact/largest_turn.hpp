#pragma once
/// How much the facets of a patch turn.

#include "contact/area_vector.hpp"
#include "osculate/mesh/half_edge_surface.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace osculate::contact {

/// Largest angle between two of the facets that share an edge, unless it is a feature edge, rad.
/// @param facets  of the surface, in any order
[[nodiscard]] inline double largest_turn(const mesh::HalfEdgeSurface& surface, std::vector<Index> facets,
                                         const std::vector<Vec3>& X) {
    std::ranges::sort(facets);
    double largest = 0;
    for (const Index f : facets) {
        const Vec3 own = area_vector(surface.facet_vertices(f), X);
        const auto across = surface.edge_neighbours(f);
        for (std::size_t c = 0; c < across.size(); ++c) {
            if (across[c] < f || !std::ranges::binary_search(facets, across[c]) ||
                surface.is_feature_edge(surface.first_half_edge(f) + static_cast<Index>(c)))
                continue;
            const Vec3 other = area_vector(surface.facet_vertices(across[c]), X);
            largest = std::max(largest, std::atan2(own.cross(other).norm(), own.dot(other)));
        }
    }
    return largest;
}

} // namespace osculate::contact
