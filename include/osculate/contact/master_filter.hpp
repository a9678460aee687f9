#pragma once
/// Takes from the motion of a master surface the waves that are too short for the mesh it is made of.

#include "osculate/mesh/half_edge_surface.hpp"

#include <span>
#include <vector>

namespace osculate::contact {

/// A slave mesh that is finer than the master's presses single master nodes into waves two facets long, which a smooth
/// surface carries on into its neighbourhood. The filter takes these out of the positions of the vertices:
///     x~ = x - m^-1 L^T Theta m (L x - c n),   Q = I - m^-1 L^T Theta m L,   dx~ = Q dx + m^-1 L^T Theta m c dn
///     m_v    sum over facets f at v of A_f / k_f, k_f corners
///     L_v u  u_v - sum over f of A_f/(k_f m_v) mean_f(u), less the smallest correction over the nodes of these facets
///            that makes it vanish for fields that are linear in the tangent plane; 0 on boundaries and at features
///     Theta_v = min(1, max(0, 2 (1 - rho))), rho the least ratio of the slave's to the master's mesh size over the edges
///            at v
///     n_v    unit normal of the facets around v, along the sum of their area vectors
///     c_v    n . L X in the reference configuration, where L X has no other component: X is linear in the tangent plane
/// On even quadrilaterals Q keeps long waves and removes those of two facets. Motions of a rigid body pass unchanged. The
/// filter depends on positions alone, not on the way there.
class MasterFilter {
public:
    /// A filter that changes nothing.
    MasterFilter() = default;
    /// @param X       (vertices) reference positions, m
    /// @param metric  of the slave mesh: 1 / size^2 = t . metric t along a direction t, m^-2
    MasterFilter(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& X, const Mat3& metric);

    /// Whether there is a vertex that it moves.
    [[nodiscard]] bool active() const { return !stencils_.empty(); }
    /// Computes the filtered positions, and their rounding errors if those of x are given.
    /// @param tails  (vertices) rounding errors of x, m, or empty
    void apply(const std::vector<Vec3>& x, std::span<const Vec3> tails, std::vector<Vec3>& filtered,
               std::vector<Vec3>& filtered_tails) const;
    /// Makes room for derivatives. Prototypes, which are only copied, need none.
    void make_room() { derivatives_.resize(Q_.size(), Mat3::Zero()); }
    /// Computes the derivatives at positions x.
    void differentiate(const std::vector<Vec3>& x);

    /// The vertices on which x~ of a vertex depends, and the entries of Q for them.
    [[nodiscard]] std::span<const Index> row(Index vertex) const { return part(columns_, vertex); }
    [[nodiscard]] std::span<const double> Q(Index vertex) const { return part(Q_, vertex); }
    /// Derivatives of x~ of a vertex by the vertices of its row, from the last differentiate().
    [[nodiscard]] std::span<const Mat3> derivatives(Index vertex) const { return part(derivatives_, vertex); }

private:
    struct Entry {
        Index vertex;
        double share;
    };
    /// L of one vertex with Theta > 0.
    struct Stencil {
        double scale = 0;                ///< Theta m, m^2
        double height = 0;               ///< c, m
        std::vector<Entry> entries;      ///< the vertex itself first; their shares sum to 0
        std::vector<std::size_t> places; ///< of the derivative of each entry's x~ by each entry, entries.size()^2
    };
    /// Sum of the area vectors around the stencil's vertex, m^2, and its derivative by each of its entries, if wanted.
    [[nodiscard]] Vec3 area_around(const Stencil& stencil, const std::vector<Vec3>& x, std::span<const Vec3> tails,
                                   std::vector<Mat3>* derivatives = nullptr) const;
    void make_rows();
    template <class T> [[nodiscard]] std::span<const T> part(const std::vector<T>& all, Index vertex) const {
        const std::size_t begin = row_start_[static_cast<std::size_t>(vertex)];
        return {all.data() + begin, row_start_[static_cast<std::size_t>(vertex) + 1] - begin};
    }

    const mesh::HalfEdgeSurface* surface_ = nullptr;
    std::vector<double> m_; ///< (vertices) m^2
    std::vector<Stencil> stencils_;
    std::vector<std::size_t> row_start_; ///< (vertices + 1) into the next three
    std::vector<Index> columns_;
    std::vector<double> Q_;
    std::vector<Mat3> derivatives_;
};

/// The mean over slave facets of 1 / size^2 in their planes, see MasterFilter. Corners of each facet in m.
[[nodiscard]] Mat3 mesh_metric(std::span<const std::vector<Vec3>> facets);

} // namespace osculate::contact
