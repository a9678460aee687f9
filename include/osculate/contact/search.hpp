#pragma once
/// Which facet of a moving surface is closest to a point: once globally, then by following it.

#include "osculate/core/types.hpp"
#include "osculate/mesh/half_edge_surface.hpp"

#include <memory>
#include <vector>

namespace osculate::contact {

/// Closest point of one facet to a slave point.
struct FacetHit {
    Index facet = -1;
    Vec2 u = Vec2::Zero(); ///< natural coordinates of the (clamped) closest point, as in FacetPatch
    double distance = 0;   ///< to the facet, m
    double overhang = 0;   ///< how far the foot on the extended facet lies beyond its edge, m; 0 inside
    bool boundary = false; ///< the closest point lies on the surface's boundary
    bool latched = false;  ///< stays on this facet, and on its side of creases, for now
    double beyond = 0;     ///< how far s lies past that boundary, in the plane of the facet there, m; 0 inside
};

/// Search over the facets of one surface; positions are those of the surface's vertices, local numbering.
class FacetSearch {
public:
    explicit FacetSearch(const mesh::HalfEdgeSurface& surface);
    /// The same, with a rule for points that are equally close to several facets, as on mesh lines: the facet whose centre
    /// lies nearer to `about` is taken, then the one that comes first turning right about the surface normal. Unlike facet
    /// numbers and round-off, that does not change when the scene is moved, renumbered or rescaled.
    /// @param X      reference positions of the surface's vertices  @param about  e.g. the centre of the slave nodes
    FacetSearch(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X, const Vec3& about);
    ~FacetSearch();
    /// The same rules and neighbours, which are shared; not built.
    FacetSearch(const FacetSearch& other);
    FacetSearch& operator=(const FacetSearch&) = delete;
    FacetSearch(FacetSearch&&) noexcept;
    FacetSearch& operator=(FacetSearch&&) noexcept;

    [[nodiscard]] FacetHit closest_on(Index facet, const Vec3& s, const std::vector<Vec3>& x) const;

    /// Bulk-loads the bounding boxes of all facets into an R-tree. O(n log n)
    void build(const std::vector<Vec3>& x);
    /// Closest facet of all, lowest number first among equals; build() must have been called at these positions. O(log n)
    [[nodiscard]] FacetHit global(const Vec3& s, const std::vector<Vec3>& x) const;

    /// Follows the point from facet `from` over facets that share a vertex. The old facet is kept until the point has left
    /// it by `hysteresis` times its size, or another is closer by as much: without that, points on an edge flip-flop.
    [[nodiscard]] FacetHit track(const Vec3& s, Index from, const std::vector<Vec3>& x, double hysteresis) const;

private:
    struct Tree;
    /// The one to be taken, whatever their order; no facet where there are none. @param hits  left in pieces
    [[nodiscard]] FacetHit best_of(std::vector<FacetHit>& hits) const;
    struct Rules {
        std::vector<Index> neighbour_start{0}, neighbours; ///< facets that share a vertex with each facet
        std::vector<Vec3> centre, normal;                  ///< of each facet, from `about`; empty without the rule
    };
    FacetSearch(const mesh::HalfEdgeSurface& surface, Rules rules);
    const mesh::HalfEdgeSurface* surface_;
    std::shared_ptr<const Rules> rules_;
    std::unique_ptr<Tree> tree_;
};

} // namespace osculate::contact
