#pragma once
/// Finds the facet of a moving surface closest to a point: once globally, then by tracking.

#include "osculate/core/types.hpp"
#include "osculate/mesh/half_edge_surface.hpp"

#include <functional>
#include <memory>
#include <vector>

namespace osculate::contact {

/// Closest point of one facet to a slave point.
struct FacetHit {
    Index facet = -1;
    Vec2 u = Vec2::Zero(); ///< natural coordinates of the (clamped) closest point, as in FacetPatch
    double distance = 0;   ///< to the facet, m
    double overhang = 0;   ///< distance of the foot on the extended facet beyond its edge, m; 0 inside
    bool boundary = false; ///< the closest point is on the surface's boundary
    bool latched = false;  ///< keeps this facet and its side of creases for now
    bool limited = false;  ///< the closest point is where facets end that count
    double beyond = 0;     ///< distance of s past that boundary, in the plane of the facet there, m; 0 inside
};

/// Search over the facets of one surface; positions are those of the surface's vertices, in local numbering.
class FacetSearch {
public:
    /// Which facets count, empty: all. The surface ends where they do.
    using Choice = std::function<bool(Index facet)>;

    explicit FacetSearch(const mesh::HalfEdgeSurface& surface);
    /// The same, with a rule for points equally close to several facets, as on mesh lines: it chooses the facet whose
    /// centre is nearest to `about`, then the first one in clockwise order about the surface normal. Unlike facet
    /// numbers and round-off, this does not depend on position, numbering or scale of the scene.
    /// @param X      reference positions of the surface's vertices
    /// @param about  e.g. the centre of the slave nodes
    FacetSearch(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X, const Vec3& about);
    /// That rule for another search on the same surface, whose list of neighbours is taken over.
    FacetSearch(const FacetSearch& other, const std::vector<Vec3>& X, const Vec3& about);
    ~FacetSearch();
    /// Copies share rules and neighbours; they are not built.
    FacetSearch(const FacetSearch& other);
    FacetSearch& operator=(const FacetSearch&) = delete;
    FacetSearch(FacetSearch&&) noexcept;
    FacetSearch& operator=(FacetSearch&&) noexcept;

    [[nodiscard]] FacetHit closest_on(Index facet, const Vec3& s, const std::vector<Vec3>& x,
                                      const Choice& counts = {}) const;

    /// Loads the bounding boxes of all facets into an R-tree. O(n log n)
    void build(const std::vector<Vec3>& x);
    /// Closest facet of all, the lowest number among equal ones unless there is a rule; call build() with these
    /// positions first. O(log n)
    [[nodiscard]] FacetHit global(const Vec3& s, const std::vector<Vec3>& x) const;
    /// The closest of the facets that count, at most `reach` away, m; no facet if there is none.
    [[nodiscard]] FacetHit global(const Vec3& s, const std::vector<Vec3>& x, double reach, const Choice& counts) const;

    /// Tracks the point from facet `from` over facets that share a vertex. It keeps the old facet until the point has
    /// left it by `hysteresis` times its size, or another facet is closer by that distance: otherwise points on an edge
    /// would alternate. From no facet (-1) it finds none.
    [[nodiscard]] FacetHit track(const Vec3& s, Index from, const std::vector<Vec3>& x, double hysteresis,
                                 const Choice& counts = {}) const;

private:
    struct Tree;
    /// The hit to choose, independent of their order; no facet if there are none. @param hits  modified
    [[nodiscard]] FacetHit best_of(std::vector<FacetHit>& hits) const;
    /// Facets that share a vertex with each facet.
    struct Neighbours {
        std::vector<Index> start{0}, facet;
    };
    struct Rules {
        std::vector<Vec3> centre, normal; ///< of each facet, relative to `about`; empty: no rule
    };
    const mesh::HalfEdgeSurface* surface_;
    std::shared_ptr<const Neighbours> neighbours_;
    std::shared_ptr<const Rules> rules_;
    std::unique_ptr<Tree> tree_;
};

} // namespace osculate::contact
