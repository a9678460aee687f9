#pragma once
/// Where points that move on straight lines go through facets that move with them.

#include "osculate/core/types.hpp"

#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace osculate::contact {

/// A point and a facet meet: at the fraction `time` of the step, the point changes sides of the facet.
struct Crossing {
    double time = 0;            ///< within [0, 1]
    Index facet = -1;           ///< as numbered in the list given
    bool inward = true;         ///< from the outward side to the other one; false: the other way round
    Vec3 normal = Vec3::Zero(); ///< unit outward normal of the facet then
    double before = 0;          ///< distance of the point from the facet's plane at time 0, m, > 0 outside ...
    double after = 0;           ///< ... and at time 1, at the place that is met
};

/// A path that ends, or stays for a while, on the inner side of a surface.
struct Passage {
    Crossing entry;    ///< the first inward crossing of it
    bool left = false; ///< the path has come out again by time 1: a body or a hill has been gone through
};

/// Facets whose vertices move linearly from x0 to x1, quadrilaterals as two triangles along their diagonal 0-2: a surface
/// that is closed stays closed, so a path cannot slip through between facets. Everything is measured relative to the mean
/// motion of the vertices.
class MovingFacets {
public:
    using Corners = std::array<Index, 4>; ///< vertices, counter-clockwise seen from outside; [3] is -1 for a triangle

    /// Bulk-loads the boxes that the facets sweep into an R-tree. O(n log n)
    MovingFacets(std::vector<Corners> facets, const std::vector<Vec3>& x0, const std::vector<Vec3>& x1);
    ~MovingFacets();
    MovingFacets(MovingFacets&&) noexcept;
    MovingFacets& operator=(MovingFacets&&) noexcept;

    /// Every crossing of a point that moves from s0 to s1, in order of time. A point that starts exactly on a facet does not
    /// cross it then. O(log n + boxes met)
    [[nodiscard]] std::vector<Crossing> crossings(const Vec3& s0, const Vec3& s1) const;
    /// The first passage that comes out, or ends, deeper than `allowed` below the plane of the facet it has entered by. What
    /// is less is a skim: a slave above a smooth surface dips into the facets that span its hollows.
    /// @param allowed  m, by facet; less than the thickness of the body there, or a path right through it is a skim, too
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

/// How thick the body is behind each of its facets, m: from the facet inward along its normal to where the exterior faces
/// outward again, the least over the facet's centre and points near its corners; infinite where nothing is met.
/// @param facets    of a body  @param exterior  all facets of it
/// @param X         positions
[[nodiscard]] std::vector<double> thickness_behind(const std::vector<MovingFacets::Corners>& facets,
                                                   const std::vector<MovingFacets::Corners>& exterior,
                                                   const std::vector<Vec3>& X);

} // namespace osculate::contact
