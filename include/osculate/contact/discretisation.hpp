#pragma once
/// How the slave nodes of a pair get their contact points: the one interface between a discretisation and the contact law.

#include "osculate/contact/contact_point.hpp"
#include "osculate/contact/master_surface.hpp"
#include "osculate/contact/search.hpp"

#include <memory>
#include <span>
#include <vector>

namespace osculate::contact {

/// Positions of a pair, and what they are looked at with. Slaves and vertices, m; all of it outlives an evaluation.
struct PairPositions {
    const MasterSurface& master;
    const FacetSearch& search;
    std::span<const Vec3> slaves;         ///< of the slave nodes
    const std::vector<Vec3>& vertices;    ///< of the master surface
    std::span<const Vec3> slave_tails{};  ///< the last digits that `slaves` lack, m; empty: none
    std::span<const Vec3> vertex_tails{}; ///< the same of `vertices`
};

/// Which facet each slave node is above, and how often that has changed within an attempt.
struct FacetTracking {
    double hysteresis = 0;        ///< of the facet size, see FacetSearch::track
    int changes_before_latch = 0; ///< after so many changes a point stays where it is: it is on an edge
    std::vector<Index> facet;     ///< (slaves) -1: none
    std::vector<int> changes;     ///< (slaves)
    std::vector<FacetHit> hits;   ///< (slaves) closest point on that facet
};

/// Contact points of all slave nodes at one set of positions, and their variations. As made by compile it holds what is fixed
/// for a run; a clone, which is evaluated, is of one attempt.
class Discretisation {
public:
    virtual ~Discretisation() = default;
    [[nodiscard]] virtual std::unique_ptr<Discretisation> clone() const = 0;

    /// Opens an attempt at the positions of its start.
    virtual void begin(const PairPositions& at, const FacetTracking& tracking, int threads) = 0;
    /// Fills the points of all slave nodes, tracked to the facets of `tracking`, which may latch more of them.
    /// @returns how many points of its own have changed their facet
    virtual int evaluate(const PairPositions& at, FacetTracking& tracking, std::vector<ContactPoint>& points,
                         int threads) = 0;
    /// Makes ready what vary() needs at the positions of the last evaluate(), for the slave nodes that are `wanted`.
    virtual void prepare_variations(const PairPositions& at, std::span<const char> wanted, int threads) {
        (void)at, (void)wanted, (void)threads;
    }
    /// First variations of point j, at the positions of the last evaluate().
    virtual void vary(Index j, const PairPositions& at, const FacetHit& hit, const ContactPoint& point,
                      ContactVariation& variation) const = 0;

    /// How many of the nodes of point j carry force: the first ones. The others only bear on the gap.
    [[nodiscard]] virtual Index carriers(Index j, const ContactPoint& point) const = 0;
    /// Change of the forces on the carriers, (3m), for a force lambda on slave j, from that of the normal and, over the
    /// carriers, of weights (m) and pressing (3m, where the variation has it).
    virtual void force_change(const ContactPoint& point, const Vec3& lambda, const Vec3& dn,
                              std::span<const double> dweights, const double* dpressing, double* df) const = 0;
    /// Change of weights and pressing along dy, as force_change() takes them.
    virtual void weights_along(const ContactPoint& point, const ContactVariation& variation, const Vector& dy,
                               Vector& dweights, Vector& dpressing) const = 0;
    /// What the gap of point j lacks, m, by the tails of the positions of the last evaluate(): so small that first variations
    /// are exact.
    [[nodiscard]] virtual double gap_rounded_off(Index j, const PairPositions& at, const ContactPoint& point) const = 0;
    /// Vertices by which the master moves below slave j, and their shares, for what needs few of them.
    virtual void follow(const FacetHit& hit, const ContactPoint& point, Index carried, std::vector<Index>& vertices,
                        std::vector<double>& shares) const = 0;
    /// Whether a slave node without a point may lie inside the master all the same, since no average sees it.
    [[nodiscard]] virtual bool overlooks() const { return false; }
};

/// Contact at the slave nodes themselves.                                                               [Qian 2014, sec 2]
/// @param surface  topology of the master
[[nodiscard]] std::unique_ptr<Discretisation> make_node_discretisation(const mesh::HalfEdgeSurface& surface);

} // namespace osculate::contact
