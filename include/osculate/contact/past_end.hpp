#pragma once
/// Slave points past the end of a master surface.

#include "osculate/contact/discretisation.hpp"

#include <array>
#include <memory>

namespace osculate::contact {

/// A master surface that goes on straight past its end. With the point c of the closest facet that is closest to s, and gap
/// g_F and normal n_F of s over that facet, extended past its edges, gap and normal at s are those of the surface at
///     s' = c + g_F n_F,
/// the point beside the end that is as high over the facet as s. A cylinder so goes on as a cylinder; the facets alone
/// would go on as a prism, a sagitta lower than the cylinder.
class PastEnd {
public:
    explicit PastEnd(const mesh::HalfEdgeSurface& surface)
        : surface_(&surface), facets_(make_facets_surface(surface)) {}

    /// A slave point past the end.
    struct Point {
        FacetHit hit;        ///< from which its point over the facet was sought
        FacetHit closest;    ///< c
        int edge = -1;       ///< of the facet, on which c is, from its corner of this number; -1: at no edge's inside
        int corner = -1;     ///< of the facet, at which c is; -1: at none
        double fraction = 0; ///< of the edge, at c
        Vec3 beside = Vec3::Zero(); ///< s', m
        ContactPoint facet, side;   ///< of s over the extended facet, of s' over the surface
        std::vector<Index> place;   ///< of the facet's nodes among those of the point
    };

    /// Gap, normal and nodes of s; the point's weights and pressing are those of s'.
    /// @param hit  closest point of the facet
    void evaluate(const Vec3& s, const FacetHit& hit, const PairPositions& at, Point& end, ContactPoint& point) const;
    /// First variations of gap and normal at a point from evaluate().
    void vary(const Vec3& s, const PairPositions& at, const Point& end, const ContactPoint& point,
              ContactVariation& variation) const;

private:
    const mesh::HalfEdgeSurface* surface_;
    std::shared_ptr<const MasterSurface> facets_;
};

} // namespace osculate::contact
