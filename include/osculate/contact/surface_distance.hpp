#pragma once
/// How far points and facets are from a surface, by the geometry of its facets alone.

#include "osculate/mesh/half_edge_surface.hpp"

#include <functional>
#include <limits>
#include <memory>
#include <span>
#include <vector>

namespace osculate::contact {

/// Distance between the segments p q and a b, m.
[[nodiscard]] double segment_distance(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b);

/// The facet of a surface that is closest to a point.
struct NearFacet {
    Index facet = -1;                                          ///< -1: there is none
    double distance = std::numeric_limits<double>::infinity(); ///< m
    bool at_end = false; ///< its closest point is on a boundary or a sharp edge of the surface
};

/// Distances from a surface where its vertices are now. Shares no code with FacetSearch, and knows no history. A
/// quadrilateral is the four triangles of both its diagonals, so that its bilinear surface is nowhere farther than it is.
class SurfaceDistance {
public:
    /// Which facets count, empty: all.
    using Choice = std::function<bool(Index facet)>;

    /// @param x  positions of the surface's vertices; both must outlive this object
    SurfaceDistance(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& x);
    ~SurfaceDistance();

    /// Distance of a point from one facet, m.
    [[nodiscard]] double from(Index facet, const Vec3& p) const;
    /// The closest of all facets. O(log n) after the first call
    [[nodiscard]] NearFacet closest(const Vec3& p, const Choice& counts = {}) const;
    /// Distance between the surface and a facet of another one, m, if it is less than `most`; else `most`.
    /// @param corners  three or four
    [[nodiscard]] double from(std::span<const Vec3> corners, double most, const Choice& counts = {}) const;

    /// Largest turn of the normal, up to 40 degrees, from a facet to those across its edges, over its size, 1/m; and by how
    /// much a quadrilateral is warped, m.
    [[nodiscard]] double curvature(Index facet) const;
    [[nodiscard]] double warp(Index facet) const;

private:
    struct Tree;
    const Tree& tree() const;
    [[nodiscard]] bool is_at_end(Index facet, const Vec3& foot) const;

    const mesh::HalfEdgeSurface& surface_;
    const std::vector<Vec3>& x_;
    mutable std::unique_ptr<const Tree> tree_; ///< made when first asked for
};

} // namespace osculate::contact
