#pragma once
/// Computes the contact points of a pair's slave nodes: the one interface between a discretisation and the contact law.

#include "osculate/contact/contact_point.hpp"
#include "osculate/contact/master_surface.hpp"
#include "osculate/contact/search.hpp"
#include "osculate/contact/slave_share.hpp"

#include <memory>
#include <span>
#include <vector>

namespace osculate::contact {

/// Positions of a pair, and the master and search to evaluate them with. All positions in m; all referenced data
/// outlives an evaluation.
struct PairPositions {
    const MasterSurface& master;
    const FacetSearch& search;
    std::span<const Vec3> slaves;         ///< of the slave nodes
    const std::vector<Vec3>& vertices;    ///< of the master surface
    std::span<const Vec3> slave_tails{};  ///< rounding errors of `slaves`, m; empty: none
    std::span<const Vec3> vertex_tails{}; ///< rounding errors of `vertices`
};

/// The facet of each slave node, and the number of its changes during an attempt.
struct FacetTracking {
    double hysteresis = 0;        ///< of the facet size, see FacetSearch::track
    int changes_before_latch = 0; ///< number of changes after which a point keeps its facet: it is on an edge
    std::vector<Index> facet;     ///< (slaves) -1: none
    std::vector<int> changes;     ///< (slaves)
    std::vector<FacetHit> hits;   ///< (slaves) closest point on that facet
    /// (slaves) Whether a node is too far from the master to touch it: it has no hit, and no point. Averages over facets all
    /// of whose nodes are may be left out. Empty: none is.
    std::vector<char> far;
    const SlaveShare* share = nullptr; ///< null: this process evaluates all slave nodes
    [[nodiscard]] bool owns(Index j) const { return share == nullptr || share->owns(j); }
};

/// Contact points of all slave nodes at one set of positions, and their variations. The object made by compile holds
/// data that is fixed for a run; its clones, which are evaluated, each belong to one attempt.
class Discretisation {
public:
    virtual ~Discretisation() = default;
    [[nodiscard]] virtual std::unique_ptr<Discretisation> clone() const = 0;

    /// Opens an attempt at the positions of its start.
    virtual void begin(const PairPositions& at, const FacetTracking& tracking, int threads) = 0;
    /// Computes the points of all slave nodes on the facets in `tracking`; may latch more of them there. Of shared ones, at
    /// least those that this process owns; what vary() and gap_rounded_off() need, too, is then there only of these.
    /// @returns number of its own points that changed their facet
    virtual int evaluate(const PairPositions& at, FacetTracking& tracking, std::vector<ContactPoint>& points,
                         int threads) = 0;
    /// Prepares vary() at the positions of the last evaluate(), for the slave nodes that are `wanted`.
    virtual void prepare_variations(const PairPositions& at, std::span<const char> wanted, int threads) {
        (void)at, (void)wanted, (void)threads;
    }
    /// First variations of point j, at the positions of the last evaluate().
    virtual void vary(Index j, const PairPositions& at, const FacetHit& hit, const ContactPoint& point,
                      ContactVariation& variation) const = 0;

    /// Number of nodes of point j that carry force: the first ones. The others affect only the gap.
    [[nodiscard]] virtual Index carriers(Index j, const ContactPoint& point) const = 0;
    /// Change of the forces on the carriers, (3m), for a force lambda on slave j, from the changes of the normal and,
    /// over the carriers, of weights (m) and pressing (3m, if the variation has it).
    virtual void force_change(const ContactPoint& point, const Vec3& lambda, const Vec3& dn,
                              std::span<const double> dweights, const double* dpressing, double* df) const = 0;
    /// Changes of weights and pressing along dy, in the form for force_change().
    virtual void weights_along(const ContactPoint& point, const ContactVariation& variation, const Vector& dy,
                               Vector& dweights, Vector& dpressing) const = 0;
    /// Rounding error of the gap of point j, m, from the tails of the positions of the last evaluate(): so small that
    /// first variations are exact.
    [[nodiscard]] virtual double gap_rounded_off(Index j, const PairPositions& at, const ContactPoint& point) const = 0;
    /// Vertices that describe the motion of the master below slave j, and their shares, for callers that need only a
    /// few vertices.
    virtual void follow(const FacetHit& hit, const ContactPoint& point, Index carried, std::vector<Index>& vertices,
                        std::vector<double>& shares) const = 0;
    /// Area that the force on slave j presses on, m^2, in the reference configuration: where forces are averages over the
    /// slave facets, the part of these that is above the master.
    /// @param tributary  the whole area for which the node stands
    [[nodiscard]] virtual double loaded_area(Index j, double tributary) const {
        (void)j;
        return tributary;
    }
    /// Appends what the process that evaluated slave j knows of it beside its point, and takes this in the others, where they
    /// ask carriers() and loaded_area().
    /// @returns  where the numbers end
    virtual void pack(Index j, std::vector<double>& numbers) const { (void)j, (void)numbers; }
    virtual const double* unpack(Index j, const double* numbers) {
        (void)j;
        return numbers;
    }
    /// Whether a slave node without a point may still be inside the master, because no average detects it.
    [[nodiscard]] virtual bool overlooks() const { return false; }
};

/// Contact at the slave nodes themselves.                                                               [Qian 2014, sec 2]
/// @param surface  topology of the master
[[nodiscard]] std::unique_ptr<Discretisation> make_node_discretisation(const mesh::HalfEdgeSurface& surface);

} // namespace osculate::contact
