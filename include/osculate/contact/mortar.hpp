#pragma once
/// Contact averaged over the slave facets with dual shape functions, instead of contact at the slave nodes.

#include "osculate/contact/contact_point.hpp"
#include "osculate/contact/discretisation.hpp"
#include "osculate/contact/dual_weights.hpp"
#include "osculate/contact/master_surface.hpp"
#include "osculate/contact/mirror.hpp"
#include "osculate/contact/search.hpp"
#include "osculate/mesh/half_edge_surface.hpp"

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace osculate::contact {

/// A smooth surface through the slave nodes, so that a curved slave is not represented by its chords.
struct SmoothSlave {
    std::unique_ptr<mesh::HalfEdgeSurface> surface; ///< the slave facets in their order, then some mirror images
    std::unique_ptr<MasterSurface> shape;
    std::vector<Vec3> X;      ///< (vertices) reference positions
    std::vector<Index> node;  ///< (vertices) slave node
    std::vector<Image> image; ///< (vertices) image of that node
};

/// Mortar weighting: the contact point of every slave node j is an average over the reference area of its facets with
/// its dual shape functions psi_j, see DualFunctions,
///     gap      g_j = int psi_j g dA / D_j               normal  n_j = N_j / |N_j|,  N_j = int psi_j n dA / D_j
///     weights  W_ji of DualWeights: a force lambda on node j loads master node i with -W_ji lambda.
/// Gap and normal are those of the master surface, from one evaluation at each point of a rule on the slave facet, or
/// on the smooth surface through the slave nodes: positions sum_k C_k s_k with constant C, m.
///
/// Slave facets that are only partly above the master are averaged over that part, with dual functions made for it. In
/// ContactPoint::nodes, numbers from surface.vertex_count() on are slave nodes, counted from there: the other nodes of
/// the facets of j, on which its gap depends. The nodes that carry force come first, carriers(j) of them.
class Mortar final : public Discretisation {
public:
    /// @param surface   topology of the master
    /// @param facets    slave facets
    /// @param S         (slaves) reference positions of the slave nodes
    /// @param in_plane  (slaves) projectors on the symmetry planes of each slave node; empty: no such planes
    /// @param smooth    null: use the slave facets themselves
    Mortar(const mesh::HalfEdgeSurface& surface, const std::vector<SlaveFacet>& facets, const std::vector<Vec3>& S,
           std::vector<Mat3> in_plane, const SmoothSlave* smooth = nullptr);

    [[nodiscard]] std::unique_ptr<Discretisation> clone() const override;
    /// Assigns the points of every slave facet to their closest master facets, found from those of the nodes.
    void begin(const PairPositions& at, const FacetTracking& tracking, int threads) override;
    int evaluate(const PairPositions& at, FacetTracking& tracking, std::vector<ContactPoint>& points,
                 int threads) override;
    void prepare_variations(const PairPositions& at, std::span<const char> wanted, int threads) override;
    /// dweights has the rows of the carriers; dpressing is not set, because all of a force is distributed by the
    /// weights.
    void vary(Index j, const PairPositions& at, const FacetHit& hit, const ContactPoint& point,
              ContactVariation& variation) const override;
    [[nodiscard]] double loaded_area(Index j, double tributary) const override {
        const double share = weights_.share(j);
        return share > 0 ? share : tributary;
    }
    [[nodiscard]] Index carriers(Index j, const ContactPoint& point) const override;
    void force_change(const ContactPoint& point, const Vec3& lambda, const Vec3& dn, std::span<const double> dweights,
                      const double* dpressing, double* df) const override;
    void weights_along(const ContactPoint& point, const ContactVariation& variation, const Vector& dy, Vector& dweights,
                       Vector& dpressing) const override;
    /// Includes the rounding errors of the positions of the points on slave facets.
    [[nodiscard]] double gap_rounded_off(Index j, const PairPositions& at, const ContactPoint& point) const override;
    void follow(const FacetHit& hit, const ContactPoint& point, Index carried, std::vector<Index>& vertices,
                std::vector<double>& shares) const override;
    [[nodiscard]] bool overlooks() const override { return true; }

private:
    struct Share {
        Index slave;
        Mat3 C;
    };
    /// A point from which the gap is averaged, at  offset + sum C s  =  s_0 + sum C (s - s_0) without mirror images.
    struct GapPoint {
        Vec2 xi = Vec2::Zero();
        DualFunctions::Row4 N = DualFunctions::Row4::Zero();
        std::vector<Share> shares;
        Vec3 offset = Vec3::Zero(); ///< of mirror images
        bool mirrored = false;
        Vec3 tail = Vec3::Zero(); ///< rounding error of its position, m
        double weight = 0;        ///< reference area
        Index facet = -1;
        int changes = 0;
        FacetHit hit;
        ContactPoint point;
    };
    struct Facet {
        SlaveFacet corners;
        std::vector<GapPoint> gap_points;
        DualFunctions dual;            ///< for the gap, over the points above the master
        std::vector<Index> gap_slaves; ///< slave nodes that affect its points, ascending
        // Variations by y, slave nodes first, then vertices.
        std::vector<Index> gap_vertices;
        Matrix dgap;    ///< (corners x 3y)
        Matrix dnormal; ///< (3 corners x 3y)
    };

    Mortar(const Mortar& other)
        : Discretisation(other), surface_(other.surface_), weights_(other.weights_), facets_(other.facets_),
          in_plane_(other.in_plane_), carriers_(other.carriers_), normal_length_(other.normal_length_) {}
    void interpolate(GapPoint& q, Index f, const SmoothSlave* smooth) const;
    [[nodiscard]] static Vec3 position(const GapPoint& q, std::span<const Vec3> s, Vec3* tail = nullptr);
    void gather(Index j, const std::vector<Vec3>& x, ContactPoint& point);
    void vary_gap(Facet& facet, const PairPositions& at) const;
    /// Sum of D_j over the facets with gaps.
    [[nodiscard]] double gap_area(Index j) const;

    const mesh::HalfEdgeSurface& surface_;
    std::unique_ptr<Placement> placement_;
    DualWeights weights_;
    std::vector<Facet> facets_;
    std::vector<Mat3> in_plane_;
    std::vector<Index> carriers_;
    std::vector<double> normal_length_; ///< (slaves) |N_j| of the last evaluation
};

} // namespace osculate::contact
