#pragma once
/// Looks for bodies inside one another, or inside themselves, by the geometry of their facets alone.

#include "osculate/mesh/mesh.hpp"

#include <memory>
#include <vector>

namespace osculate::contact {

/// The deepest place at which one body lies inside another, or has gone through itself.
struct Intrusion {
    Index body = -1;  ///< whose node or edge it is
    Index other = -1; ///< that it lies in; `body` itself where a body passes through itself
    Index node = -1;  ///< global; where it is an edge that lies inside, one of its ends
    bool edge = false;
    Vec3 place = Vec3::Zero();
    double depth = 0;  ///< distance to the surface of `other`, m
    double excess = 0; ///< depth less the sagitta of the facets there, >= 0, m
    double length = 1; ///< size of the larger of the facets that meet there, m

    /// In facets.
    [[nodiscard]] double relative() const { return excess / length; }
};

/// What an audit found: per pair of bodies that lie inside one another the deepest place, ascending by their numbers, and
/// nodes that lie inside a body with their excess, ascending.
struct AuditResult {
    std::vector<Intrusion> intrusions;
    std::vector<std::pair<Index, double>> nodes;

    /// With the largest relative(); null where nothing lies inside anything.
    [[nodiscard]] const Intrusion* worst() const;
    /// Largest excess between two bodies, m; 0 where there is none.
    [[nodiscard]] double between(Index body, Index other) const;
};

/// The outer surfaces of all bodies. Two closed surfaces that do not touch lie inside one another only where an edge of one
/// goes through a facet of the other, or where one contains the other whole: both are looked for among near pairs, found
/// by R-trees over the current boxes. From the ends of such edges the nodes inside are found neighbour by neighbour; their
/// depth is the distance to the closest facet, its side told by the normal there. An edge with both ends outside is as deep
/// as the middle between where it enters and leaves. No contact status, pair or gap is asked.
///
/// Facets are chords: smooth surfaces bulge over them by the sagitta h theta/8, theta the turn of the normal over a facet of
/// size h. Where facets of unlike size h meet surfaces of curvature theta_a/h_a and theta_b/h_b, nodes may lie
///     s = h^2/8 (theta_a/h_a + theta_b/h_b) + w,   h = max(h_a, h_b)
/// deep in facets while the surfaces just touch, w the height by which a quadrilateral is warped. Turns of more than 40
/// degrees are edges, and have none.
class SurfaceAudit {
public:
    /// @param bodies  outer facets of each body, global nodes, normals outward
    /// @param X       reference positions of all nodes, m
    SurfaceAudit(const std::vector<std::vector<mesh::Facet>>& bodies, const std::vector<Vec3>& X);
    ~SurfaceAudit();

    /// At positions x of all nodes.
    [[nodiscard]] AuditResult examine(const std::vector<Vec3>& x) const;

private:
    struct Shell;
    class Examination;
    std::vector<Shell> shells_;
    std::vector<Index> shell_node_; ///< (nodes) number of the node within its body's shell; -1: inside the body
};

} // namespace osculate::contact
