#pragma once
/// Contact of one pair during an attempt at a step: its contact points, and quantities derived from them.

#include "osculate/core/timing.hpp"
#include "osculate/model/contact_pair.hpp"

#include <limits>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace osculate::model {

/// What laws of contact need of it.
struct DynamicStep {
    double dt = 0;     ///< s
    double weight = 0; ///< of forces at the end, 1 - alpha_f of the integrator
};
/// Energy that an interface takes in a step, J.
struct Taken {
    double damping = 0;     ///< by its damping, and where it would pull
    double algorithmic = 0; ///< where forces at the end weigh more than those at the start
};

/// Facets of an evaluation, for take_facets().
struct HeldFacets {
    std::vector<Index> facet;  ///< (slaves)
    std::vector<char> latched; ///< (slaves)
};

class ContactEvaluation {
public:
    explicit ContactEvaluation(const ContactPair& pair); ///< must outlive this object
    /// Copies are for inspection: vary() needs an evaluate() first. They hold no geometry.
    ContactEvaluation(const ContactEvaluation& other);
    ContactEvaluation& operator=(const ContactEvaluation& other) { return *this = ContactEvaluation(other); }
    ContactEvaluation(ContactEvaluation&&) noexcept = default;
    ContactEvaluation& operator=(ContactEvaluation&&) noexcept = default;
    ~ContactEvaluation() = default;

    [[nodiscard]] const ContactPair& pair() const { return *pair_; }
    /// Shares the slave nodes out among processes: each evaluates some in evaluate() and tells the others what it found.
    /// begin_step() and evaluate() are collective then. General contact and contact of edges is evaluated by all.
    void share_out(Ranks& ranks) { share_.emplace(ranks, pair_->size()); }
    /// Whether this process evaluates slave j: vary() needs that.
    [[nodiscard]] bool owns(Index j) const { return !share_ || share_->owns(j); }
    [[nodiscard]] const contact::SlaveShare* share() const { return share_ ? &*share_ : nullptr; }
    /// Evaluates every slave node here, at the positions of the last evaluate(), for vary() of all of them.
    void evaluate_all_here(int threads);
    /// The master surface of the attempt.
    [[nodiscard]] const std::shared_ptr<const contact::MasterSurface>& master() const { return master_; }

    /// Opens a step at nodal positions x, from which slips are measured. Nodes that are not closed are searched again
    /// over the whole surface.
    /// @param tails  (nodes) rounding errors of x, the digits that x lacks, m; empty: none
    void begin_step(const std::vector<Vec3>& x, const ContactHistory& history, Timings& timings, int threads,
                    const std::vector<Vec3>& tails = {});
    /// Of general contact: from the next begin_step() on, nodes that cannot have touched anything, by how far they and the
    /// master have moved or by how far they are in front of a facet, have no point. Their gaps stay unknown, all else is as it
    /// would be.
    void pass_over_far_nodes(bool on) { passes_over_ = on; }
    /// Facets as at the start of the step again, none latched: what a solve that failed went through does not count.
    void forget_path();
    /// Until begin_step(), facets are those of another evaluation of the same slaves and master, at positions that differ a little:
    /// where a slave is as near to one as to another, both take the same.
    void take_facets(HeldFacets facets);
    [[nodiscard]] HeldFacets held_facets() const;
    /// Keeps partners, normals and weights of the last evaluate() from now on, until let_go() or begin_step(): gaps are then linear in
    /// the positions. For pairs with contact at nodes or of edges. @pre prepare_variations() with all that have a point
    void hold_geometry();
    void let_go() { held_geometry_.clear(); }
    [[nodiscard]] bool holds_geometry() const { return !held_geometry_.empty(); }
    /// How far slave j, which has a point, has moved relative to its master since hold_geometry(), m.
    [[nodiscard]] double moved_since_held(Index j) const;
    /// Evaluates every slave node at positions x, starting each search from the node's last facet.
    void evaluate(const std::vector<Vec3>& x, Timings& timings, int threads, const std::vector<Vec3>& tails = {});

    [[nodiscard]] const contact::ContactPoint& point(Index j) const { return points_[j]; }
    /// Area that the force on slave j presses on, m^2: of the reference configuration, and only the part above the
    /// master where the discretisation knows it.
    [[nodiscard]] double area(Index j) const { return discretisation_->loaded_area(j, pair_->slaves().area[j]); }
    /// Smallest gap of all slave nodes with a contact partner, m, over depths that are kept; infinite if none has one. A node
    /// that is passed over counts with what it may move before it is not.
    [[nodiscard]] double least_gap() const;
    /// What presses on the slave side over the force on slave j: 1, and for an edge, whose two ends share it, 1/(1 - s), see
    /// contact::make_edge_discretisation(). Drifts are those of the contact point times this.
    [[nodiscard]] double whole(Index j) const {
        return pair_->slaves().edges && points_[j].found ? 1 - points_[j].weights(0) : 1;
    }
    /// Closest point of slave j on its facet, whether or not there is contact.
    [[nodiscard]] const contact::FacetHit& hit(Index j) const { return tracking_.hits[j]; }
    /// Gap of slave node j itself, m, if the discretisation averages gaps and may overlook it, and it has no contact
    /// point; infinite if it has one or is neither above nor below the master.
    [[nodiscard]] double unseen_gap(Index j) const;
    /// Global nodes of the patch of slave j, in the order of point(j).weights.
    [[nodiscard]] const std::vector<Index>& point_nodes(Index j) const { return point_nodes_[j]; }
    /// Global nodes of the patch that the facet of slave j would use, whether or not there is contact.
    [[nodiscard]] std::vector<Index> patch_nodes(Index facet) const;
    /// Displacement of slave j relative to the master between two displacement fields, at its current contact point, m.
    [[nodiscard]] Vec3 drift(Index j, const std::vector<Vec3>& from, const std::vector<Vec3>& to) const;
    /// The same since the step began.
    [[nodiscard]] Vec3 drift(Index j) const { return drift(j, start_, now_); }
    /// Of general contact, once after begin_step() with the positions there: where bodies are inside one another by more than
    /// contacts yield, contact keeps this part of the depth.
    void keep_depths(double part, const std::vector<Vec3>& x, Timings& timings, int threads,
                     const std::vector<Vec3>& tails = {});
    /// Of a dynamic step, once after begin_step() with the positions there. Interfaces that give way have the mean pressure of
    /// the step then, whose work is the change of the interface's energy.
    void take_step(const std::vector<Vec3>& x, const DynamicStep& step, Timings& timings, int threads,
                   const std::vector<Vec3>& tails = {});
    /// Coulomb's coefficient at slave j in this step: that of rest until it has slid, see ContactHistory::slides.
    [[nodiscard]] double friction(Index j) const;
    /// What sliding meets beside friction, N/m: the force over the displacement in the step. Of slaves that were closed at its
    /// start.
    [[nodiscard]] double drag(Index j) const;
    /// Which slaves slide after a step that ends with these statuses; empty: it makes no difference.
    [[nodiscard]] std::vector<char> slides(const std::vector<contact::Status>& statuses) const;
    /// Energy of the interface at slave j, J; 0 if it does not give way.
    [[nodiscard]] double stored(Index j) const;
    /// What the law takes of the energy in a step with this contact force, J; zeros if it does not give way.
    [[nodiscard]] Taken taken(Index j, const Vec3& lambda) const;
    /// Input of the contact law, from differences of displacements and of reference positions, so that the distance of
    /// the bodies from the origin has no effect. The drift is computed only with friction.
    [[nodiscard]] contact::ContactState state(Index j, const Vec3& lambda) const {
        contact::ContactState state = states_[j];
        state.lambda = lambda;
        return state;
    }
    /// c of the complementarity function of slave j, N/m: its stiffness and, in dynamics, its inertia.
    [[nodiscard]] double stiffness(Index j, const Vec3& lambda) const;
    /// Sets the inertia of the slave nodes, N/m: about mass over the square of the time step.
    void set_inertia(std::vector<double> inertia) { inertia_ = std::move(inertia); }
    /// Declares which slave nodes are held or driven along some direction: their stick is elastic, see
    /// contact::Coulomb.
    void hold(std::vector<char> held) { held_ = std::move(held); }
    /// The law at a contact force, which it depends on where an interface gives way.
    [[nodiscard]] contact::Coulomb law(Index j, const Vec3& lambda) const;
    /// What is zero where slave j is in contact, m: its gap, and by how much it gives way.
    [[nodiscard]] double distance(Index j, const Vec3& lambda) const {
        return law(j, lambda).distance(states_[j].gap, lambda.dot(points_[j].normal));
    }
    /// Prepares calls of vary() for the slave nodes that are `wanted`.
    void prepare_variations(std::span<const char> wanted, int threads);
    /// Computes the variations of contact point j.
    void vary(Index j, contact::ContactVariation& variation) const;
    /// Derivative of the drift d of state() with respect to y = (slave, masters), 3 x 3+3n.
    void drift_variation(Index j, const contact::ContactVariation& variation, Matrix& dd) const;
    /// Force on master node i of the patch of slave j: p_i (lambda . n) - Phi_i (lambda - n n . lambda).
    [[nodiscard]] Vec3 master_force(Index j, Index i, const Vec3& lambda) const;
    /// Number of point_nodes(j) that carry force: the first ones. The others affect only the gap.
    [[nodiscard]] Index carriers(Index j) const { return discretisation_->carriers(j, points_[j]); }
    /// Calls add(node, force) for slave j and for the master nodes loaded by the contact force lambda on it, with
    /// global nodes, N.
    template <class Add> void for_each_force(Index j, const Vec3& lambda, Add&& add) const {
        add(pair_->slaves().node[j], lambda);
        if (!points_[j].found) return;
        for (Index i = 0, n = carriers(j); i < n; ++i) add(point_nodes_[j][i], master_force(j, i, lambda));
    }
    /// Derivatives of the forces on the m masters that carry force: (3m x 3) by lambda, (3m x 3+3n) by y.
    [[nodiscard]] contact::MatrixX3 master_force_by_lambda(Index j) const;
    void master_force_by_y(Index j, const Vec3& lambda, const contact::ContactVariation& variation, Matrix& by_y) const;
    /// Change (3m) of these forces when the nodes of y move by dy (3+3n), mirror images folded; overwrites dy.
    void master_force_along(Index j, const Vec3& lambda, const contact::ContactVariation& variation, Vector& dy,
                            Vector& df) const;

    /// Motion of the master below slave j: with mortar by its weights, otherwise at the closest point of the closest
    /// facet. For each node, shape function times image.
    void follow_master(Index j, std::vector<Index>& nodes, std::vector<Mat3>& follow) const;
    /// Converts derivatives by the vertices of the patch to derivatives by their nodes: A (3 x 3+3n), E (3m x 3) and G
    /// (3m x 3+3n). Changes them only if there are mirror images.
    void fold(Index j, Matrix& A, contact::MatrixX3& E) const;
    void fold(Index j, Matrix& G) const;

    [[nodiscard]] const std::vector<Index>& facets() const { return tracking_.facet; }
    /// Facet changes at the last evaluation.
    [[nodiscard]] int facet_changes() const { return facet_changes_; }

private:
    /// Values of a nodal field at the slave nodes, and at the master nodes (before any mirroring).
    struct Places {
        std::vector<Vec3> slaves, masters;
    };
    /// What hold_geometry() keeps of a point.
    struct HeldPoint {
        double gap = 0;                              ///< m
        Eigen::Matrix<double, 1, Eigen::Dynamic> dg; ///< (3+3n) first variation of the gap; empty: no partner
    };
    /// Positions of the slave and of the n nodes of its point, m, (3+3n).
    [[nodiscard]] Vector point_positions(Index j) const;
    /// The share of a pair whose points are shared, too; null: all are evaluated here.
    [[nodiscard]] const contact::SlaveShare* shared_points() const;
    /// Shares the slave nodes out by their work in the step that begins.
    void share_out_by_work(const ContactHistory& history);
    void exchange_hits();
    /// Points, what the discretisation knows beside them, and rounded_.
    void exchange_points();
    /// Extracts these values from a field; nothing from an empty field.
    void gather(const std::vector<Vec3>& field, Places& into) const;
    [[nodiscard]] const Vec3& at(const Places& places, Index vertex) const;
    [[nodiscard]] contact::PairPositions positions() const;
    void place(const std::vector<Vec3>& x, const std::vector<Vec3>& tails);
    /// See SlaveNodes::along.
    void drop_what_is_not_pointed_at(const std::vector<Vec3>& x);
    /// Computes facets_ and faces_ from the positions of the moment, those of all nodes being x.
    void place_facets(const std::vector<Vec3>& x);
    /// Whether slave j may touch a facet in this attempt, see SlaveNodes::around and OwnSurface.
    [[nodiscard]] bool may_touch(Index j, Index facet) const;
    /// See SlaveNodes::yields.
    [[nodiscard]] bool yields(Index j) const {
        const SlaveNodes& slaves = pair_->slaves();
        return slaves.edges || (!slaves.yields.empty() && slaves.yields[static_cast<std::size_t>(j)] != 0);
    }
    /// See SlaveNodes::watched.
    [[nodiscard]] bool watched(Index j) const {
        return !pair_->slaves().watched.empty() && pair_->slaves().watched[static_cast<std::size_t>(j)] != 0;
    }
    /// Whether a node that yields is where slaves of the pair in the other direction have the contact.
    [[nodiscard]] bool is_left_to_slaves(Index j) const;
    /// Whether the closest facet, of those that may be touched, is not below the node but beside it.
    [[nodiscard]] bool looks_past(Index j) const;
    /// Ends contact of slave j where its facet does, by what the closest point tells; and where general contact ends it.
    void end_at_bounds(Index j);
    /// How far from a node facets are looked for, m.
    [[nodiscard]] double reach() const {
        return pair_->slaves().own ? pair_->slaves().own->reach : std::numeric_limits<double>::max();
    }
    /// Facets at the start of an attempt, and closest_: what they were if nothing has changed.
    /// @param before  positions that these were found for
    void find_facets(const std::vector<Vec3>& x, const ContactHistory& history, const Places& before, int threads);
    /// Computes clearance_ from these.
    void find_clearances(const ContactHistory& history);
    /// Computes tracking_.far at the positions of the moment.
    void find_far_nodes();
    /// Adds nodes in front of their closest facets, by more than that, to tracking_.far.
    void pass_over_clear_nodes();
    /// How far slave j is in front of the plane of a facet, m.
    [[nodiscard]] double height(Index j, Index facet) const;
    [[nodiscard]] bool is_far(Index j) const { return !tracking_.far.empty() && tracking_.far[j] != 0; }
    void drop_what_is_beside();
    /// Facets to look for slave j on.
    [[nodiscard]] contact::FacetSearch::Choice choice(Index j) const;
    /// area() of a pair that gives way, m^2, > 0.
    [[nodiscard]] double soft_area(Index j) const;
    /// How far the interface gives way at slave j: overclosure, m, and compliance, m/N, at a contact force.
    struct GivesWay {
        double overclosure = 0, compliance = 0;
    };
    [[nodiscard]] GivesWay gives_way(Index j, const Vec3& lambda) const;
    /// Mean contact force of the step at slave j along the normal, N, < 0 where damping would pull, and minus its derivative by the
    /// gap, N/m.
    [[nodiscard]] contact::Overclosure::Mean mean_force(Index j) const;
    /// The law of a mean contact force, from mean_force().
    [[nodiscard]] contact::Coulomb law_of_means(Index j) const;
    /// Gap that contact keeps in this attempt, m, <= 0, see keep_depths().
    [[nodiscard]] double kept_depth(Index j) const;
    /// state() of slave j without the force.
    [[nodiscard]] contact::ContactState measure(Index j, const contact::PairPositions& at) const;
    [[nodiscard]] const Mat3& image(Index j, Index i) const { return pair_->image(points_[j].nodes[i]); }
    [[nodiscard]] Vec3 drift(Index j, const Places& from, const Places& to) const;
    /// From the motion of the slave and moved(vertex), the motions of the master's nodes.
    template <class Moved> [[nodiscard]] Vec3 drift(Index j, const Vec3& slave, const Moved& moved) const;

    const ContactPair* pair_;
    std::optional<contact::SlaveShare> share_; ///< none: all slave nodes are this process'
    std::vector<double> rounded_;              ///< (slaves) rounding errors of gaps, m, where points are shared
    std::unique_ptr<contact::Discretisation> discretisation_;
    contact::FacetSearch search_;
    std::shared_ptr<const contact::MasterSurface> master_;
    std::vector<double> inertia_; ///< (slaves) N/m
    std::vector<char> held_;      ///< (slaves) in the current stage
    std::vector<Vec3> lambda_start_;
    std::vector<Index> facet_start_;            ///< (slaves) at the start of the step, see forget_path()
    std::vector<Index> facet_before_;           ///< (slaves) of the history then
    std::vector<contact::Status> status_start_; ///< (slaves)
    std::vector<contact::FacetHit>
        closest_;                ///< (slaves) closest point of all facets then, of nodes that are not closed
    Places start_, now_;         ///< positions, m
    Places tails_start_, tails_; ///< their rounding errors, m; empty: none
    std::vector<Vec3> vertices_, vertex_tails_; ///< current, of the master surface
    struct {
        std::vector<Vec3> normal, centre;
    } facets_; ///< of the master surface at the start of the attempt; empty: not needed, see SlaveNodes::around
    /// (facets) How far the master surface may rise above each then, m.
    std::vector<double> bulge_;
    std::vector<std::vector<Vec3>> faces_; ///< (slaves) normals of the facets around each node then
    contact::FacetTracking tracking_;
    /// (slaves) General contact: whether the contact had a point at the last evaluation, or was closed when the attempt
    /// started; it loses it later then. And at the start.
    std::vector<char> in_force_, in_force_start_;
    std::vector<char>
        given_; ///< (slaves) of facets that are given: whether the other's point is latched; empty: none is given
    std::vector<contact::ContactPoint> points_;
    std::vector<char> points_at_; ///< (slaves) whether the node points at the master there, see SlaveNodes::along
    std::vector<double> depth_;   ///< (slaves) see kept_depth(), NaN for nodes that had no partner then; empty: none
    double kept_part_ = 0;
    std::vector<double> overclosure_start_; ///< (slaves) see take_step(), m; empty: the force at the end counts
    DynamicStep step_;                      ///< zeros in statics
    std::vector<char> slides_;              ///< (slaves) see ContactHistory; empty: friction is the same at rest
    std::vector<Vec3> vertices_start_;      ///< of the master surface at the start of the attempt, of general contact
    bool passes_over_ = false;              ///< see pass_over_far_nodes()
    /// (slaves) How far the node and the master may move in the attempt, together, before they could touch, m; negative if they
    /// may touch. Empty: no node is passed over.
    std::vector<double> clearance_;
    std::vector<double> left_;                  ///< (slaves) what is left of it at the last evaluation, m
    std::vector<contact::ContactState> states_; ///< without forces
    std::vector<std::vector<Index>> point_nodes_;
    int facet_changes_ = 0;
    std::vector<HeldPoint> held_geometry_; ///< (slaves) empty: nothing is held
    std::vector<Vector> held_positions_;   ///< (slaves) point_positions() then
};

/// One for each pair.
using ContactEvaluations = std::vector<ContactEvaluation>;
[[nodiscard]] ContactEvaluations contact_evaluations(const ContactPairs& pairs);
/// The pairs of a state.
[[nodiscard]] ContactPairs pairs_of(const std::vector<ContactHistory>& contact);

} // namespace osculate::model
