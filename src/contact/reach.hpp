#pragma once
/// Where a master surface ends.

#include "osculate/contact/search.hpp"

namespace osculate::contact {

/// A point beyond the boundary by more than this fraction of the facet's size is no contact; less is round-off of meshes
/// that end together.
inline constexpr double boundary_margin = 0.01;
/// A point deeper than this many facet sizes is behind the surface, not in contact with it.
inline constexpr double deepest = 2.0;

inline bool beyond_boundary(const FacetHit& hit, double facet_size) {
    return hit.facet < 0 || hit.beyond > boundary_margin * facet_size;
}

} // namespace osculate::contact
