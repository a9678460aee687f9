#pragma once
/// Facets of any surfaces that are near each other.

#include "osculate/mesh/mesh.hpp"

#include <functional>
#include <utility>
#include <vector>

namespace osculate::contact {

/// Largest cosine between the normals of facets that face each other: ten degrees from edge-on.
inline constexpr double facing = -0.17;

/// All pairs of facets, the lower number first, ascending, whose bounding boxes overlap after each is extended by its
/// facet's margin: every two facets whose margins together bridge the distance between them, and a few more. An R-tree of
/// every group holds the boxes of its facets. O((n + pairs) log n) for each two groups that are near each other
/// @param group   (facets) number of the group that each belongs to, from 0 on
/// @param margin  (facets) m
/// @param x       positions of the facets' nodes, m
/// @param meet    whether pairs of two groups, or within one, count; called with the lower number first
/// @param wanted  whether a pair counts; called with the lower number first
[[nodiscard]] std::vector<std::pair<Index, Index>>
near_facets(const std::vector<mesh::Facet>& facets, const std::vector<Index>& group, const std::vector<double>& margin,
            const std::vector<Vec3>& x, const std::function<bool(Index, Index)>& meet,
            const std::function<bool(Index, Index)>& wanted);

} // namespace osculate::contact
