#pragma once
/// Contact averaged over the slave facets with dual shape functions, instead of contact at the slave nodes.

#include "osculate/contact/contact_point.hpp"
#include "osculate/contact/discretisation.hpp"
#include "osculate/contact/facet_overlap.hpp"
#include "osculate/contact/master_surface.hpp"
#include "osculate/contact/mirror.hpp"
#include "osculate/contact/search.hpp"
#include "osculate/mesh/half_edge_surface.hpp"

#include <array>
#include <memory>
#include <span>
#include <vector>

namespace osculate::contact {

/// A facet of the slave surface; corners in the numbering of the slave nodes.
struct SlaveFacet {
    int count = 0;
    std::array<Index, 4> node{};
    [[nodiscard]] const Index* begin() const { return node.data(); }
    [[nodiscard]] const Index* end() const { return node.data() + count; }
};

/// A smooth surface through the slave nodes, so that a curved slave is not represented by its chords.
struct SmoothSlave {
    std::unique_ptr<mesh::HalfEdgeSurface> surface; ///< the slave facets in their order, then some mirror images
    std::unique_ptr<MasterSurface> shape;
    std::vector<Vec3> X;      ///< (vertices) reference positions
    std::vector<Index> node;  ///< (vertices) slave node
    std::vector<Image> image; ///< (vertices) image of that node
};

/// Mortar weighting: every slave node j has the dual shape functions psi_j of its facets,
///     psi = A N,  A = D M^-1,  M = int N N^T dA,  D = diag(int N dA),  so that  int psi_j N_k dA = delta_jk D_j,
/// and its contact point is an average with them over the reference area of those facets,
///     gap      g_j = int psi_j g dA / D_j               normal  n_j = N_j / |N_j|,  N_j = int psi_j n dA / D_j
///     weights  W_ji = int psi_j N_i dA / D_j           a force lambda on node j loads master node i with -W_ji lambda.
/// Gap and normal are those of the master surface, from one evaluation at each point of a rule on the slave facet, or
/// on the smooth surface through the slave nodes: positions sum_k C_k s_k with constant C, m. The weights are the shape
/// functions N_i of the master's facets, so that the master receives a constant pressure as the nodal loads that its
/// elements balance with constant stress: the patch test. They have kinks, and are integrated over the overlaps of
/// slave and master facets.
///
/// Slave facets that are only partly above the master are averaged over that part, with dual functions made for it. In
/// ContactPoint::nodes, numbers from surface.vertex_count() on are slave nodes, counted from there: the other nodes of
/// the facets of j, on which its gap depends. The nodes that carry force come first, carriers(j) of them.
/// After Wohlmuth, SIAM J. Numer. Anal. 38 (2000) 989-1012; Popp et al., Int. J. Numer. Meth. Eng. 83 (2010) 1428-1465.
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
    using Row4 = Eigen::Matrix<double, 4, 1>;
    using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 4>;

    struct Share {
        Index slave;
        Mat3 C;
    };
    /// A point from which the gap is averaged, at  offset + sum C s  =  s_0 + sum C (s - s_0) without mirror images.
    struct GapPoint {
        Vec2 xi = Vec2::Zero();
        Row4 N = Row4::Zero();
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
    struct Overlap {
        Index facet = -1; ///< of the master
        std::vector<OverlapPoint> points;
    };
    /// Linear map from shape functions to dual ones, and the integrals D.
    struct Dual {
        bool usable = false;
        Square A;
        Row4 D = Row4::Zero();
    };
    struct Facet {
        SlaveFacet corners;
        std::vector<Vec3> X; ///< (corners) reference
        double area = 0;     ///< reference
        std::vector<GapPoint> gap_points;
        std::vector<Overlap> overlaps;
        Dual gap_dual, weight_dual;
        std::vector<Index> gap_slaves; ///< slave nodes that affect its points, ascending
        // Variations by y, slave nodes first, then vertices: of the gap by gap_slaves, of the weights by the corners.
        std::vector<Index> gap_vertices, weight_vertices;
        Matrix dgap;     ///< (corners x 3y)
        Matrix dnormal;  ///< (3 corners x 3y)
        Matrix dweights; ///< (corners * weight_vertices x 3y), corner by corner
    };
    struct Incidence {
        Index facet;
        int corner;
    };

    static void interpolate(GapPoint& q, const Facet& facet, Index number, const SmoothSlave* smooth);
    [[nodiscard]] static Vec3 position(const GapPoint& q, std::span<const Vec3> s, Vec3* tail = nullptr);
    [[nodiscard]] static std::vector<Vec3> corners(const Facet& facet, std::span<const Vec3> s);
    void find_overlaps(Facet& facet, const PairPositions& at) const;
    void make_duals(Facet& facet) const;
    void gather(Index j, const std::vector<Vec3>& x, ContactPoint& point);
    void vary_gap(Facet& facet, const PairPositions& at) const;
    void vary_weights(Facet& facet, const PairPositions& at) const;
    /// Sum of D_j over the facets with gaps, or with weights.
    [[nodiscard]] double gap_area(Index j) const;
    [[nodiscard]] double weight_area(Index j) const;
    /// Area of the reference facet per unit of natural coordinates, m^2.
    [[nodiscard]] static double reference_area(const Facet& facet, const Vec2& xi);

    const mesh::HalfEdgeSurface& surface_;
    std::unique_ptr<Placement> placement_;
    std::vector<Facet> facets_;
    std::vector<std::vector<Incidence>> incident_; ///< (slaves)
    std::vector<Mat3> in_plane_;
    std::vector<Index> carriers_;
    std::vector<double> normal_length_; ///< (slaves) |N_j| of the last evaluation
};

} // namespace osculate::contact
