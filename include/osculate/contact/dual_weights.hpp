#pragma once
/// Shares of the master's vertices in the force on a slave node, by integrals over the slave facets.

#include "osculate/contact/discretisation.hpp"
#include "osculate/contact/facet_overlap.hpp"
#include "osculate/mesh/half_edge_surface.hpp"

#include <array>
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

/// Dual shape functions of a slave facet over a part of it,
///     psi = A N,  A = D M^-1,  M = int N N^T dA,  D = diag(int N dA),  so that  int psi_j N_k dA = delta_jk D_j.
struct DualFunctions {
    using Row4 = Eigen::Matrix<double, 4, 1>;
    using Square = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 4, 4>;
    bool usable = false; ///< false: the part is too small, or a line
    Square A;
    Row4 D = Row4::Zero();
};

/// The integrals of which dual functions are made, summed over the points of a part of a facet.
class DualSum {
public:
    explicit DualSum(int corners) : corners_(corners), M_(DualFunctions::Square::Zero(corners, corners)) {}
    void add(const DualFunctions::Row4& N, double weight) {
        M_ += weight * N.head(corners_) * N.head(corners_).transpose();
        covered_ += weight;
    }
    /// @param area         of the whole facet, m^2
    /// @param least_cover  a part that is smaller than this share of the facet is not usable: the dual functions of a
    ///                     sliver are huge
    void finish(double area, double least_cover, DualFunctions& dual) const;

private:
    int corners_;
    DualFunctions::Square M_;
    double covered_ = 0;
};

/// Area of a reference facet with corners X per unit of natural coordinates, m^2.
[[nodiscard]] double reference_area(const std::vector<Vec3>& X, const Vec2& xi);
[[nodiscard]] std::vector<Vec3> corner_positions(const SlaveFacet& facet, std::span<const Vec3> slaves);

/// The weights
///     W_ji = int psi_j N_i dA / D_j
/// with dual functions of the slave facets and the shape functions N_i of the master's facets: a force lambda on slave j
/// loads vertex i with -W_ji lambda. So a constant pressure loads the master as its elements balance it with constant
/// stress: the patch test. The shape functions have kinks, and are integrated over the overlaps of slave and master
/// facets; a slave facet that is partly above the master, over that part. sum_i W_ji = 1.
/// After Wohlmuth, SIAM J. Numer. Anal. 38 (2000) 989-1012; Popp et al., Int. J. Numer. Meth. Eng. 83 (2010) 1428-1465.
class DualWeights {
public:
    struct Incidence {
        Index facet;
        int corner;
    };

    /// @param surface  topology of the master
    /// @param S        (slaves) reference positions of the slave nodes
    DualWeights(const mesh::HalfEdgeSurface& surface, const std::vector<SlaveFacet>& facets, const std::vector<Vec3>& S,
                double least_cover);

    [[nodiscard]] Index facet_count() const { return static_cast<Index>(facets_.size()); }
    [[nodiscard]] const SlaveFacet& corners(Index f) const { return facets_[f].corners; }
    /// Reference positions of the corners, m, and the facet's area there, m^2.
    [[nodiscard]] const std::vector<Vec3>& X(Index f) const { return facets_[f].X; }
    [[nodiscard]] double area(Index f) const { return facets_[f].area; }
    /// Facets of a slave node.
    [[nodiscard]] const std::vector<Incidence>& around(Index j) const { return incident_[j]; }
    [[nodiscard]] bool usable(Index f) const { return facets_[f].dual.usable; }

    /// Chooses for a while what each slave facet may load: a surface with feature edges has facets that a slave facet sees
    /// edge-on or nearly so, next to those that it faces, and these do not share the load of the others.
    void begin(const PairPositions& at);
    /// Finds what of the master slave facet f lies above, and its dual functions there.
    /// @param seeds  master facets to begin with, in any order; the search goes on to neighbours as long as they overlap
    void update(Index f, const PairPositions& at, std::vector<Index> seeds);
    /// As if slave facet f were above nothing.
    void leave_out(Index f) { facets_[static_cast<std::size_t>(f)].dual.usable = false; }
    /// D_j, m^2: the area for which slave j stands; 0 where it is not above the master.
    [[nodiscard]] double share(Index j) const;
    /// Appends the vertices that carry the force on j, some of them more than once.
    void add_vertices(Index j, std::vector<Index>& vertices) const;
    /// Adds W_ji to `weights`. @param carriers  these vertices, ascending
    void add_weights(Index j, const std::vector<Index>& carriers, Vector& weights) const;

    /// Calls use(master facet, reference area, N, N of the master) for the points of what of facet f is above the master.
    template <class Use> void for_each_point(Index f, Use&& use) const {
        for (const Overlap& overlap : facets_[static_cast<std::size_t>(f)].overlaps)
            for (const Point& q : overlap.points) use(overlap.facet, q.area, q.N, q.of_master);
    }

    /// Computes the variations of facet f at the positions of its last update().
    void vary(Index f, const PairPositions& at);
    /// Adds the variations of W_ji to dweights, (carriers x 3+3n).
    /// @param weights      W_ji of the carriers
    /// @param row          place of a vertex among the carriers
    /// @param of_slave, of_vertex  first column of a slave node and of a vertex
    template <class Row, class OfSlave, class OfVertex>
    void add_variations(Index j, const Vector& weights, Row&& row, OfSlave&& of_slave, OfVertex&& of_vertex,
                        Matrix& dweights) const;

private:
    struct Point {
        Vec2 u;                           ///< natural coordinates on the master facet
        double area;                      ///< weight: reference area, m^2
        DualFunctions::Row4 N, of_master; ///< shape functions of both facets
    };
    /// A point at which the part of a facet above the master ends, since the master ends there.
    struct BorderPoint {
        std::array<Index, 2> ends; ///< vertices of the edge
        double s, weight;          ///< share of the edge from the first; reference area per distance that it moves, m
        DualFunctions::Row4 N;
    };
    struct Overlap {
        Index facet = -1; ///< of the master
        std::vector<Point> points;
    };
    struct Facet {
        SlaveFacet corners;
        std::vector<Vec3> X;        ///< (corners) reference
        double area = 0;            ///< reference
        Vec3 normal = Vec3::Zero(); ///< at the last begin()
        std::vector<Overlap> overlaps;
        DualFunctions dual;
        std::vector<Index> vertices;                     ///< of the overlaps, ascending
        Eigen::Matrix<double, 4, Eigen::Dynamic> shares; ///< int psi_c N_i dA, m^2: corner c, vertex i
        std::vector<BorderPoint> border;
        Matrix variation; ///< of the shares, (corners * vertices x 3y), corner by corner; y: corners, then vertices
        Matrix dD;        ///< of D, (corners x 3y); empty without a border: D is constant
    };

    /// Whether a slave facet faced a master facet at the last begin().
    [[nodiscard]] bool faces(const Facet& facet, Index master) const;
    void find_border(Facet& facet, const PairPositions& at, const SlavePlane& plane,
                     const std::vector<Vec3>& corner) const;
    /// Adds what the motion of the border does. @param turn  (corners) vectors e of dA = e x ds
    void vary_border(Facet& facet, const PairPositions& at, const SlavePlane& plane,
                     const std::array<Vec3, 4>& turn) const;

    const mesh::HalfEdgeSurface& surface_;
    double least_cover_;
    bool turns_round_;
    std::vector<Vec3> master_normal_; ///< (master facets) at the last begin(); empty without features
    std::vector<Facet> facets_;
    std::vector<std::vector<Incidence>> incident_; ///< (slaves)
};

template <class Row, class OfSlave, class OfVertex>
void DualWeights::add_variations(Index j, const Vector& weights, Row&& row, OfSlave&& of_slave, OfVertex&& of_vertex,
                                 Matrix& dweights) const {
    const double by = share(j);
    const Index carriers = dweights.rows();
    for (const auto& [f, k] : incident_[static_cast<std::size_t>(j)]) {
        const Index corner = k; // a lambda takes no parts of a pair
        const Facet& facet = facets_[static_cast<std::size_t>(f)];
        if (!facet.dual.usable) continue;
        const auto count = static_cast<Index>(facet.vertices.size());
        Index from = 0;
        const auto add = [&](Index to) {
            for (Index i = 0; i < count; ++i)
                dweights.block<1, 3>(row(facet.vertices[static_cast<std::size_t>(i)]), to) +=
                    facet.variation.block<1, 3>(corner * count + i, from) / by;
            if (facet.dD.size() > 0)
                dweights.middleCols<3>(to) -= weights.head(carriers) * (facet.dD.block<1, 3>(corner, from) / by);
            from += 3;
        };
        for (const Index slave : facet.corners) add(of_slave(slave));
        for (const Index v : facet.vertices) add(of_vertex(v));
    }
}

/// Gaps at the slave nodes, forces by DualWeights.
/// @param surface   topology of the master
/// @param vertices  reference positions of its vertices
/// @param S         (slaves) reference positions of the slave nodes
/// @param in_plane  (slaves) projectors on the symmetry planes of each slave node; empty: no such planes
[[nodiscard]] std::unique_ptr<Discretisation>
make_petrov_galerkin(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& vertices,
                     const std::vector<SlaveFacet>& facets, const std::vector<Vec3>& S, std::vector<Mat3> in_plane);

} // namespace osculate::contact
