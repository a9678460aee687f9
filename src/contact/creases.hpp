#pragma once
/// Where the smooth sides of a surface meet.

#include "osculate/contact/search.hpp"
#include "osculate/mesh/half_edge_surface.hpp"

#include <cmath>
#include <vector>

namespace osculate::contact {

/// Facets of other smooth sides that meet each facet in a feature edge or in a corner.
class Creases {
public:
    struct Neighbour {
        int corner; ///< the edge is the one that leaves it
        bool edge;
        Index facet;
    };

    explicit Creases(const mesh::HalfEdgeSurface& surface);

    [[nodiscard]] bool none() const { return none_; }
    [[nodiscard]] const std::vector<Neighbour>& of(Index facet) const { return of_[static_cast<std::size_t>(facet)]; }
    /// Facets of the other sides where a point lies beyond a crease, so that its closest point is on one.
    [[nodiscard]] std::vector<Index> across(const FacetHit& hit) const;

    /// Whether a point lies on another side than its facet's. Beyond a crease both sides are planes, more or less, through it: the
    /// one that the point is farther from faces it. For a convex edge that is the larger gap, for a concave one the smaller; a
    /// tie keeps the facet.
    /// @param gap, other  over the facet and over that of the other side, m
    [[nodiscard]] static bool is_on_other(double gap, double other, double facet_size) {
        return std::abs(other) > std::abs(gap) + tie * facet_size;
    }

private:
    static constexpr double tie = 1e-9; ///< of coordinates and gaps, of the facet size

    const mesh::HalfEdgeSurface* surface_;
    std::vector<std::vector<Neighbour>> of_;
    bool none_ = true;
};

} // namespace osculate::contact
