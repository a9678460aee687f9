#pragma once
/// Looks for nodes inside rigid bodies with exact surfaces, by their geometry.

#include "osculate/contact/surface_audit.hpp"
#include "osculate/model/model.hpp"

#include <Eigen/Geometry>
#include <vector>

namespace osculate::time {

/// Of every body that has a pair with an exact surface, the outer nodes that were outside it as drawn, and all slave nodes.
/// Where the surface is comes of a best fit to all nodes of its body, and distances from formulas of their own, of angles
/// and lengths in the current configuration: nothing is shared with what contact computes. Facets of these nodes are sampled,
/// too: a surface may cut into them between their nodes by the sagitta of its curvature, of turns up to 40 degrees a facet.
class ExactAudit {
public:
    /// @param outer  outer facets of each body, global nodes
    ExactAudit(const model::Model& model, const std::vector<std::vector<mesh::Facet>>& outer);
    [[nodiscard]] bool empty() const { return hosts_.empty(); }
    /// Adds what it finds at positions x of all nodes.
    void examine(const Field& x, contact::AuditResult& result) const;

private:
    /// Nodes of one body against one surface.
    struct Guest {
        Index body = -1;
        std::vector<Index> nodes;
        std::vector<mesh::Facet> facets; ///< outer ones of these nodes
        double length = 1;               ///< mean facet size, m
    };
    /// The deepest sample of the facets, if it is deeper than `deepest`.
    void cut_facets(const contact::ExactShape& shape, const Guest& guest, const Field& x, const Eigen::Isometry3d& back,
                    contact::Intrusion& deepest) const;
    struct Host {
        const model::RigidBody* rigid = nullptr;
        std::vector<Guest> guests;
    };
    const model::Model& model_;
    std::vector<Host> hosts_;
};

/// Distance of a point from a shape, > 0 outside the solid, m; infinite beyond the ends of a profile. By formulas of angles and
/// lengths, arcs of profiles by chords of a 64th.
[[nodiscard]] double audited_distance(const contact::ExactShape& shape, const Vec3& point);

} // namespace osculate::time
