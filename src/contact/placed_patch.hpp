#pragma once
/// Vertex patches in one configuration, and what a slave point sees of them.

#include "contact/vertex_patch.hpp"
#include "osculate/contact/projection.hpp"

#include <vector>

namespace osculate::contact {

/// Holds all points of a patch within its bump.
struct Ball {
    Vec3 centre = Vec3::Zero();
    double radius = -1; ///< negative: of no patch

    [[nodiscard]] bool reaches(const Vec3& s, double distance) const {
        return (s - centre).squaredNorm() <= (radius + distance) * (radius + distance);
    }
};

/// A patch in one configuration, positions from its first vertex, which keeps round-off local.
struct PlacedPatch {
    Vec3 origin = Vec3::Zero(); ///< position of the first vertex
    MatrixX3 coefficients;
    PatchPoint at_vertex; ///< Taylor series about the vertex, with `third`
    PatchThird third;
    Eigen::Matrix<double, 2, 3> onto_plane; ///< (X,a . X,b)^-1 X,b there
    bool regular = false;                   ///< false: an iterate that ran away has its facets in one place
    Ball ball;
    /// Points of the bump are at a root of tau of at most this on the tangent plane, plus so much per distance from them, m^-1.
    double flat_reach = 0, flat_reach_by_distance = 0;

    void place(const VertexPatch& patch, const std::vector<Vec3>& vertices);
    /// The Taylor series at natural coordinates u from the vertex; positions from the vertex.
    [[nodiscard]] PatchPoint near_vertex(const Vec2& u) const;

private:
    void find_reach(const VertexPatch& patch);
};

/// A vertex patch seen from the slave point, within its bump.
///     du_a = K^-1_ab ( X,b.(ds - Phi_i dx_i) + g n.Phi_i,b dx_i ),  dg = n.(ds - Phi_i dx_i),
///     dpsi = -6 kappa (1-tau)^2 u^T M du
struct ActivePatch {
    const VertexPatch* patch = nullptr;
    const PlacedPatch* placed = nullptr;
    Foot foot;
    Vec3 normal;
    double gap = 0, tau = 0, psi = 0;
    Mat2 K_inverse; ///< (X,a . X,b - g n . X,ab)^-1
    Vec2 by_foot;   ///< dpsi/du
};

/// Looks at a patch from s. @param most  greatest distance of a foot, m
/// @returns  false where s has no foot on it within its bump: `seen` is then undefined
[[nodiscard]] bool see(const Vec3& s, const VertexPatch& patch, const PlacedPatch& placed, double most,
                       ActivePatch& seen);

} // namespace osculate::contact
