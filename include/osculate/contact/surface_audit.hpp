#pragma once
/// Detects bodies that penetrate each other or themselves, from the geometry of their facets alone.

#include "osculate/mesh/mesh.hpp"

#include <array>
#include <memory>
#include <vector>

namespace osculate::contact {

/// The deepest place at which one body is inside another, or has passed through itself.
struct Intrusion {
    Index body = -1;                  ///< the body of the node or edge
    Index other = -1;                 ///< the body that contains it; `body` itself for self-penetration
    Index node = -1;                  ///< global; for an edge or a facet, one of its nodes
    bool edge = false, facet = false; ///< neither: the node itself
    Vec3 place = Vec3::Zero();
    double depth = 0;  ///< distance to the surface of `other`, m
    double excess = 0; ///< depth minus the sagitta of the facets there, >= 0, m
    double length = 1; ///< size of the larger of the facets that meet there, m

    /// Excess in facet sizes.
    [[nodiscard]] double relative() const { return excess / length; }
};

/// A place at which one body is inside another, and what meets there.
struct IntrudedPlace {
    Index body = -1, other = -1;  ///< the body that is inside, and the one around it
    std::array<Index, 4> parts{}; ///< global nodes of the node, edge or facet of `body`; -1: fewer
    std::array<Index, 4>
        facet{}; ///< global nodes of the facet of `other` that it went through; the last of a triangle -1
    double depth = 0, excess = 0; ///< see Intrusion, m
    double length = 1;            ///< see Intrusion, m
};

/// Result of an audit: for each pair of bodies that penetrate each other the deepest place, ascending by their numbers;
/// and nodes inside a body with their excess, ascending.
struct AuditResult {
    std::vector<Intrusion> intrusions;
    std::vector<std::pair<Index, double>> nodes;
    std::vector<IntrudedPlace> places; ///< between two bodies, in the order in which they were found

    /// The intrusion with the largest relative(); null if there are none.
    [[nodiscard]] const Intrusion* worst() const;
    /// Largest excess between two bodies, m; 0 if there is none.
    [[nodiscard]] double between(Index body, Index other) const;
};

/// The outer surfaces of all bodies. Two closed surfaces that do not touch penetrate each other only if an edge of one
/// crosses a facet of the other, or if one contains the other completely. Both cases are searched among near pairs,
/// found by R-trees over the current boxes. From the ends of such edges the nodes inside are found neighbour by
/// neighbour; their depth is the distance to the closest facet, with the side from the normal there. An edge with both
/// ends outside is as deep as the midpoint between its entry and exit. From nodes that lie on the other surface, as where
/// flat bodies end in one plane, the middles of edges and facets are looked at too. Contact status, pairs and gaps are not
/// used.
///
/// Facets are chords: smooth surfaces bulge beyond them by the sagitta h theta/8, where theta is the rotation of the
/// normal over a facet of size h. If facets of different size h meet surfaces of curvature theta_a/h_a and theta_b/h_b,
/// nodes may be
///     s = h^2/8 (theta_a/h_a + theta_b/h_b) + w,   h = max(h_a, h_b)
/// deep in facets while the surfaces just touch, where w is the warping height of a quadrilateral. Rotations of more
/// than 40 degrees are edges, without sagitta, and h theta_a/h_a and h theta_b/h_b count up to 40 degrees: a ball smaller than
/// the facets it lies on is no arc over them.
class SurfaceAudit {
public:
    /// @param bodies  outer facets of each body, global nodes, normals outward
    /// @param X       reference positions of all nodes, m
    SurfaceAudit(const std::vector<std::vector<mesh::Facet>>& bodies, const std::vector<Vec3>& X);
    ~SurfaceAudit();

    /// Audits positions x of all nodes.
    [[nodiscard]] AuditResult examine(const std::vector<Vec3>& x) const;
    /// What was found at X.
    [[nodiscard]] const AuditResult& drawn() const { return drawn_; }

private:
    struct Shell;
    class Examination;
    std::vector<Shell> shells_;
    std::vector<Index> shell_node_; ///< (nodes) number of the node within its body's shell; -1: inside the body
    AuditResult drawn_;
};

} // namespace osculate::contact
