#pragma once
/// Contact where an edge crosses an edge: convex feature edges of two surfaces, each between two facets.

#include "osculate/contact/discretisation.hpp"
#include "osculate/mesh/half_edge_surface.hpp"

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <vector>

namespace osculate::contact {

/// Edges that are nearer to parallel than this sine have no crossing to speak of.
inline constexpr double least_sine = 0.05;

/// The common perpendicular of the lines a0 a1 and b0 b1: its ends are a0 + s (a1 - a0) and b0 + t (b1 - b0).
struct LineCrossing {
    double s = 0, t = 0;
    Vec3 across = Vec3::Zero(); ///< unit, along (a1 - a0) x (b1 - b0)
    Vec3 offset = Vec3::Zero(); ///< from the end on b to that on a, m
    double sine = 0;            ///< of the angle between the lines
};
[[nodiscard]] LineCrossing cross_lines(const Vec3& a0, const Vec3& a1, const Vec3& b0, const Vec3& b1);

/// An edge between two facets.
struct SharpEdge {
    std::array<Vec3, 2> end;
    std::array<Vec3, 2> wings; ///< unit, normal to the edge, into the facets
};
/// @param centres  of the two facets
[[nodiscard]] SharpEdge sharp_edge(const std::array<Vec3, 2>& end, const std::array<Vec3, 2>& centres);
/// @param x  positions of the surface's vertices
[[nodiscard]] SharpEdge sharp_edge(const mesh::HalfEdgeSurface& surface, Index half_edge, const std::vector<Vec3>& x);
/// The two vertices of an edge, and the two facets.
[[nodiscard]] std::array<Index, 2> vertices_of_edge(const mesh::HalfEdgeSurface& surface, Index half_edge);
[[nodiscard]] std::array<Index, 2> facets_at_edge(const mesh::HalfEdgeSurface& surface, Index half_edge);
/// Sine of the angle by which a unit vector normal to both edges leaves the cone of outward normals of b, or its opposite that
/// of a; negative: both are inside.
[[nodiscard]] double out_of_cones(const Vec3& normal, const SharpEdge& a, const SharpEdge& b);
/// Sine up to which that counts as inside: faces that lie on one another have their normals at the border.
inline constexpr double cone_tolerance = 0.1;
/// The same where an audit has found them in one another: whatever separates them will do.
inline constexpr double watched_tolerance = 0.5;

/// Two edges that move on straight lines come to cross from outside one another.
struct EdgePassage {
    double time = 0;              ///< of the crossing, within [0, 1]
    double before = 0, after = 0; ///< their distance at times 0 and 1, m, > 0 outside
};
/// The first passage that ends inside.
/// @param a0, b0  at time 0  @param a1, b1  at time 1
[[nodiscard]] std::optional<EdgePassage> first_passage(const SharpEdge& a0, const SharpEdge& b0, const SharpEdge& a1,
                                                       const SharpEdge& b1);

/// An edge of the slave that may touch one of the master. Slave number j is where the first begins.
struct EdgesThatMeet {
    Index end = -1;                              ///< where it ends, number among the positions of slaves
    std::array<std::array<Index, 4>, 2> wings{}; ///< nodes of its facets, such numbers; -1: none
    Index half_edge = -1;                        ///< of the master surface
    Index reverse = -1;                          ///< number of the item that begins where this one ends
    bool watched = false;                        ///< the edges may meet however deep they are in one another at first
};

/// The slave's edge of item j. @param at  position of a number, m
template <class At> [[nodiscard]] SharpEdge slave_edge(Index j, const EdgesThatMeet& item, const At& at) {
    std::array<Vec3, 2> centres{Vec3::Zero(), Vec3::Zero()};
    for (std::size_t k = 0; k < 2; ++k) {
        const auto count = std::ranges::count_if(item.wings[k], [](Index number) { return number >= 0; });
        for (const Index number : item.wings[k])
            if (number >= 0) centres[k] += at(number) / static_cast<double>(count);
    }
    return sharp_edge({at(j), at(item.end)}, centres);
}

/// With the crossing at s of the slave's edge a and t of the master's edge b, the unit normal n = +-(a1 - a0) x (b1 - b0)/|..|
/// on the side where it is in the cone of normals of b and -n in that of a:
///     g = n . ((1 - s) a0 + s a1 - (1 - t) b0 - t b1)
/// The force lambda is that on a0. So a1 carries s/(1 - s) of it, and b0, b1 carry -(1 - t)/(1 - s) and -t/(1 - s): all that
/// ContactPoint asks for, with Phi = (-s, 1 - t, t)/(1 - s). What presses on the edge is lambda/(1 - s), and drifts are those of
/// the crossing over 1 - s. An edge has one item from each end: that of the nearer end at the start of the attempt is in force,
/// and remains so until the other is clearly nearer. The side and whether the cones meet are those of the start, too. Without a
/// contact point, gap and normal are those of the lines, m; infinite where the edges cannot meet.
/// @param surface  topology of the master; the discretisation refers to it
[[nodiscard]] std::unique_ptr<Discretisation> make_edge_discretisation(const mesh::HalfEdgeSurface& surface,
                                                                       std::vector<EdgesThatMeet> edges);

} // namespace osculate::contact
