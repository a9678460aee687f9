#pragma once
/// Takes from the motion of a master surface the waves that are too short for the mesh it is made of.

#include "osculate/mesh/half_edge_surface.hpp"

#include <span>
#include <utility>
#include <vector>

namespace osculate::contact {

/// A slave mesh that is finer than the master's presses single master nodes into waves two facets long, which a smooth
/// surface carries on into its neighbourhood. The filter takes these out of the positions of the vertices:
///     x~ = x - m^-1 L^T Theta m (L x - R L X),       dx~ = Q dx,  Q = I - m^-1 L^T Theta m L
///     m_v    sum over facets f at v of A_f / k_f, k_f corners
///     L_v u  u_v - sum over f of A_f/(k_f m_v) mean_f(u), less the smallest correction over the nodes of these facets
///            that makes it vanish for fields that are linear in the tangent plane; 0 on boundaries and at features
///     Theta_v = min(1, max(0, 2 (1 - rho))), rho the least ratio of the slave's to the master's mesh size over the edges
///            at v
///     R      rotation of the surface around v, as at the start of the attempt
/// On even quadrilaterals Q keeps long waves and removes those of two facets. Motions of a rigid body pass unchanged.
class MasterFilter {
public:
    /// A filter that changes nothing.
    MasterFilter() = default;
    /// @param X       (vertices) reference positions, m
    /// @param metric  of the slave mesh: 1 / size^2 = t . metric t along a direction t, m^-2
    MasterFilter(const mesh::HalfEdgeSurface& surface, std::vector<Vec3> X, const Mat3& metric);

    /// Whether there is a vertex that it moves.
    [[nodiscard]] bool active() const { return !stencils_.empty(); }
    /// Takes the rotations from positions x, (vertices) m.
    void begin(const std::vector<Vec3>& x);
    /// Computes the filtered positions, and their rounding errors if those of x are given.
    /// @param tails  (vertices) rounding errors of x, m, or empty
    void apply(const std::vector<Vec3>& x, std::span<const Vec3> tails, std::vector<Vec3>& filtered,
               std::vector<Vec3>& filtered_tails) const;

    struct Entry {
        Index vertex;
        double share;
    };
    /// Row of Q: the vertices on which x~ of a vertex depends.
    [[nodiscard]] std::span<const Entry> row(Index vertex) const {
        return {rows_.data() + row_start_[static_cast<std::size_t>(vertex)],
                rows_.data() + row_start_[static_cast<std::size_t>(vertex) + 1]};
    }

private:
    /// L of one vertex with Theta > 0.
    struct Stencil {
        Index vertex = -1;
        double scale = 0;              ///< Theta m, m^2
        std::vector<Entry> entries;    ///< without the vertex itself: their shares sum to minus its own
        Vec3 reference = Vec3::Zero(); ///< L X, m
        Vec3 turned = Vec3::Zero();    ///< R L X
    };
    [[nodiscard]] Vec3 normal(const Stencil& stencil, const std::vector<Vec3>& x) const;
    void make_rows();

    const mesh::HalfEdgeSurface* surface_ = nullptr;
    std::vector<Vec3> X_;
    std::vector<double> m_; ///< (vertices) m^2
    std::vector<Stencil> stencils_;
    std::vector<std::size_t> row_start_;
    std::vector<Entry> rows_;
};

/// The mean over slave facets of 1 / size^2 in their planes, see MasterFilter. Corners of each facet in m.
[[nodiscard]] Mat3 mesh_metric(std::span<const std::vector<Vec3>> facets);

} // namespace osculate::contact
