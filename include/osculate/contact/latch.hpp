#pragma once
/// What a latched point may do.

namespace osculate::contact {

/// Of the facet size: a point that is latched to a facet keeps it as FacetSearch::track() does with this hysteresis, wide enough for
/// points that alternate between two facets. One that is farther from its facet is latched to the facet that tracking finds:
/// iterates that ran away may have latched it anywhere, and a facet that is not below a point says nothing of its gap.
inline constexpr double latched_hysteresis = 0.25;

} // namespace osculate::contact
