#pragma once
/// Crossings of points that move on straight lines with facets that also move.

#include "osculate/core/types.hpp"

#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <vector>

namespace osculate::contact {

/// A point crosses a facet at the fraction `time` of the step.
struct Crossing {
    double time = 0;            ///< within [0, 1]
    Index facet = -1;           ///< number in the given list
    bool inward = true;         ///< from the outer to the inner side; false: from inner to outer
    Vec3 normal = Vec3::Zero(); ///< unit outward normal of the facet at that time
    double before = 0;          ///< distance of the point from the facet's plane at time 0, m, > 0 outside ...
    double after = 0;           ///< ... and at time 1, at the crossed place of the facet
};

/// A path that ends, or stays for some time, on the inner side of a surface.
struct Passage {
    Crossing entry;    ///< its first inward crossing
    bool left = false; ///< the path has left again by time 1: it has passed through a body or a hill
};

/// Facets whose vertices move linearly from x0 to x1, quadrilaterals as two triangles along their diagonal 0-2: a
/// closed surface remains closed, so no path can slip between facets. All motions are relative to the mean motion of
/// the vertices.
class MovingFacets {
public:
    using Corners = std::array<Index, 4>; ///< vertices, counter-clockwise seen from outside; [3] is -1 for a triangle

    /// Loads the swept bounding boxes of the facets into an R-tree. O(n log n)
    MovingFacets(std::vector<Corners> facets, const std::vector<Vec3>& x0, const std::vector<Vec3>& x1);
    ~MovingFacets();
    MovingFacets(MovingFacets&&) noexcept;
    MovingFacets& operator=(MovingFacets&&) noexcept;

    /// All crossings of a point that moves from s0 to s1, in order of time. A start exactly on a facet is not a
    /// crossing. O(log n + boxes met)
    [[nodiscard]] std::vector<Crossing> crossings(const Vec3& s0, const Vec3& s1) const;
    /// The first passage that leaves, or ends, deeper than `allowed` below the plane of the facet through which it
    /// entered. Shallower passages are ignored: a slave above a smooth surface dips into the facets that span its
    /// hollows.
    /// @param allowed  m, by facet; less than the thickness of the body there, or a path right through it is ignored,
    ///                 too. Facets that allow everything do not count
    template <class Allowed>
    [[nodiscard]] std::optional<Passage> first_passage(const Vec3& s0, const Vec3& s1, const Allowed& allowed) const;

private:
    struct Tree;
    void cross(const Corners& triangle, Index facet, const Vec3& s0, const Vec3& s1,
               std::vector<Crossing>& found) const;

    std::vector<Corners> facets_;
    std::vector<Vec3> x0_, x1_; ///< x1 without the mean motion
    Vec3 mean_ = Vec3::Zero();
    std::unique_ptr<Tree> tree_;
};

template <class Allowed>
std::optional<Passage> MovingFacets::first_passage(const Vec3& s0, const Vec3& s1, const Allowed& allowed) const {
    std::optional<Crossing> entry;
    for (const Crossing& crossing : crossings(s0, s1)) {
        if (!std::isfinite(allowed(crossing.facet))) continue;
        if (!entry) {
            if (crossing.inward) entry = crossing;
        } else if (!crossing.inward) {
            const double depth = -(entry->before + crossing.time * (entry->after - entry->before));
            if (depth > allowed(entry->facet)) return Passage{*entry, true};
            entry.reset();
        }
    }
    if (!entry || -entry->after <= allowed(entry->facet)) return std::nullopt;
    return Passage{*entry, false};
}

/// Thickness of the body behind each of its facets, m: distance from the facet along its inward normal to the next
/// outward crossing of the exterior, the least over the facet's centre and points near its corners; infinite if there
/// is none.
/// @param facets    of a body
/// @param exterior  all its facets
/// @param X         positions
[[nodiscard]] std::vector<double> thickness_behind(const std::vector<MovingFacets::Corners>& facets,
                                                   const std::vector<MovingFacets::Corners>& exterior,
                                                   const std::vector<Vec3>& X);

} // namespace osculate::contact
