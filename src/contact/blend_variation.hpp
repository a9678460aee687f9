#pragma once
/// Patches as the vertex gap blend sees them from one slave point, and the variations of what it makes of them.

#include "contact/vertex_patch.hpp"
#include "osculate/contact/contact_point.hpp"
#include "osculate/contact/projection.hpp"

namespace osculate::contact {

using Rows2 = Eigen::Matrix<double, 2, Eigen::Dynamic>;
using Rows3 = Eigen::Matrix<double, 3, Eigen::Dynamic>;
using Row = Eigen::Matrix<double, 1, Eigen::Dynamic>;

/// A patch in one configuration, positions from its first vertex, which keeps round-off local.
struct PlacedPatch {
    std::vector<Vec3> x; ///< of its vertices, as given
    MatrixX3 nodes;      ///< the same, from x[0]
    MatrixX3 coefficients;
    PatchPoint at_vertex;

    [[nodiscard]] bool is_at(const VertexPatch& patch, const std::vector<Vec3>& vertices) const {
        if (x.empty()) return false;
        for (std::size_t i = 0; i < x.size(); ++i)
            if (x[i] != vertices[patch.vertices[i]]) return false;
        return true;
    }
    void place(const VertexPatch& patch, const std::vector<Vec3>& vertices) {
        const auto n = static_cast<Index>(patch.vertices.size());
        x.resize(patch.vertices.size());
        nodes.resize(n, 3);
        for (Index i = 0; i < n; ++i) {
            x[i] = vertices[patch.vertices[i]];
            nodes.row(i) = (x[i] - x[0]).transpose();
        }
        coefficients = patch.shape.coefficients(nodes);
        at_vertex = patch.shape.point(patch.origin, coefficients);
    }
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
    Vector phi;
    MatrixX2 phi_a;
    Mat2 K_inverse;           ///< (X,a . X,b - g n . X,ab)^-1
    Vec2 by_foot;             ///< dpsi/du
    std::vector<Index> place; ///< of the patch's nodes in the union of all patches
};

/// First variations of the blend's point: of gap and normal, and where they are wanted of weights and pressing.
void vary_blend(const std::vector<ActivePatch>& active, const Vec3& s, const ContactPoint& point,
                ContactVariation& variation);

} // namespace osculate::contact
