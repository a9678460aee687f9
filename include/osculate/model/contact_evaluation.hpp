#pragma once
/// What contact finds in an attempt at a step: the contact points of a pair, and what follows from them.

#include "osculate/core/timing.hpp"
#include "osculate/model/contact_pair.hpp"

#include <memory>
#include <span>
#include <vector>

namespace osculate::model {

class ContactEvaluation {
public:
    explicit ContactEvaluation(const ContactPair& pair); ///< must outlive this object
    /// To be looked at: vary() needs an evaluate() first.
    ContactEvaluation(const ContactEvaluation& other);
    ContactEvaluation& operator=(const ContactEvaluation& other) { return *this = ContactEvaluation(other); }
    ContactEvaluation(ContactEvaluation&&) noexcept = default;
    ContactEvaluation& operator=(ContactEvaluation&&) noexcept = default;
    ~ContactEvaluation() = default;

    [[nodiscard]] const ContactPair& pair() const { return *pair_; }
    /// The master surface of the attempt.
    [[nodiscard]] const std::shared_ptr<const contact::MasterSurface>& master() const { return master_; }

    /// Opens a step at nodal positions x: slips are measured from here. Nodes that are not closed are searched anew over
    /// the whole surface.
    /// @param tails  (nodes) the last digits that x lacks, m; empty: none
    void begin_step(const std::vector<Vec3>& x, const ContactHistory& history, Timings& timings, int threads,
                    const std::vector<Vec3>& tails = {});
    /// Evaluates every slave node at positions x, following each from its last facet.
    void evaluate(const std::vector<Vec3>& x, Timings& timings, int threads, const std::vector<Vec3>& tails = {});

    [[nodiscard]] const contact::ContactPoint& point(Index j) const { return points_[j]; }
    /// Of all slave nodes with a contact partner, m; infinite where none has one.
    [[nodiscard]] double least_gap() const;
    /// Closest point of slave j on its facet, whether or not there is contact.
    [[nodiscard]] const contact::FacetHit& hit(Index j) const { return tracking_.hits[j]; }
    /// Where averages overlook slave nodes: the gap of node j itself, where it has no point, m; infinite where it has one and
    /// where it is not above or below the master.
    [[nodiscard]] double unseen_gap(Index j) const;
    /// Global nodes of the patch of slave j, in the order of point(j).weights.
    [[nodiscard]] const std::vector<Index>& point_nodes(Index j) const { return point_nodes_[j]; }
    /// Global nodes of the patch that the facet of slave j would use, whether or not there is contact.
    [[nodiscard]] std::vector<Index> patch_nodes(Index facet) const;
    /// Displacement of slave j relative to the master between two displacement fields, at its current contact point, m.
    [[nodiscard]] Vec3 drift(Index j, const std::vector<Vec3>& from, const std::vector<Vec3>& to) const;
    /// The same since the step began.
    [[nodiscard]] Vec3 drift(Index j) const { return drift(j, start_, now_); }
    /// What the law needs to know, from differences of displacements and of reference positions: how far the bodies are from
    /// the origin changes nothing. Without friction no drift.
    [[nodiscard]] contact::ContactState state(Index j, const Vec3& lambda) const {
        contact::ContactState state = states_[j];
        state.lambda = lambda;
        return state;
    }
    /// c of the complementarity function of slave j, N/m: stiffness and, in dynamics, what inertia adds to it.
    [[nodiscard]] double stiffness(Index j) const { return pair_->slaves().stiffness[j] + inertia_[j]; }
    /// Inertia of the slave nodes, N/m: mass over the square of the time step, more or less.
    void set_inertia(std::vector<double> inertia) { inertia_ = std::move(inertia); }
    /// Declares which slave nodes are held or driven along some direction: their stick is elastic, see contact::Coulomb.
    void hold(std::vector<char> held) { held_ = std::move(held); }
    [[nodiscard]] contact::Coulomb law(Index j) const;
    /// Opens a round of vary(), for the slave nodes that are `wanted`.
    void prepare_variations(std::span<const char> wanted, int threads);
    /// Variations of point j.
    void vary(Index j, contact::ContactVariation& variation) const;
    /// Derivative of the drift d of state() with respect to y = (slave, masters), 3 x 3+3n.
    void drift_variation(Index j, const contact::ContactVariation& variation, Matrix& dd) const;
    /// Force on master node i of the patch of slave j: p_i (lambda . n) - Phi_i (lambda - n n . lambda).
    [[nodiscard]] Vec3 master_force(Index j, Index i, const Vec3& lambda) const;
    /// How many of point_nodes(j) carry force: the first ones. The others only bear on the gap.
    [[nodiscard]] Index carriers(Index j) const { return discretisation_->carriers(j, points_[j]); }
    /// add(node, force) for slave j and the nodes of the master that a contact force lambda on it loads, global, N.
    template <class Add> void for_each_force(Index j, const Vec3& lambda, Add&& add) const {
        add(pair_->slaves().node[j], lambda);
        if (!points_[j].found) return;
        for (Index i = 0, n = carriers(j); i < n; ++i) add(point_nodes_[j][i], master_force(j, i, lambda));
    }
    /// The derivatives of the forces on the m masters that carry force: (3m x 3) by lambda, (3m x 3+3n) by y.
    [[nodiscard]] contact::MatrixX3 master_force_by_lambda(Index j) const;
    void master_force_by_y(Index j, const Vec3& lambda, const contact::ContactVariation& variation, Matrix& by_y) const;
    /// Its change (3m) with the nodes of y, mirror images folded, moving by dy (3+3n), which is used up.
    void master_force_along(Index j, const Vec3& lambda, const contact::ContactVariation& variation, Vector& dy,
                            Vector& df) const;

    /// How the master moves below slave j: with mortar by its weights, else as the closest point of the closest facet.
    /// Shape function times image for each node.
    void follow_master(Index j, std::vector<Index>& nodes, std::vector<Mat3>& follow) const;
    /// Turns derivatives by the vertices of the patch into derivatives by their nodes: A (3 x 3+3n), E (3m x 3) and G
    /// (3m x 3+3n). Nothing changes but for mirror images.
    void fold(Index j, Matrix& A, contact::MatrixX3& E) const;
    void fold(Index j, Matrix& G) const;

    [[nodiscard]] const std::vector<Index>& facets() const { return tracking_.facet; }
    /// Facet changes at the last evaluation.
    [[nodiscard]] int facet_changes() const { return facet_changes_; }

private:
    /// Values of a nodal field at the slave nodes, and at the nodes whose images the master's vertices are.
    struct Places {
        std::vector<Vec3> slaves, masters;
    };
    /// Takes them from a field; none from an empty one.
    void gather(const std::vector<Vec3>& field, Places& into) const;
    [[nodiscard]] const Vec3& at(const Places& places, Index vertex) const;
    [[nodiscard]] contact::PairPositions positions() const;
    void place(const std::vector<Vec3>& x, const std::vector<Vec3>& tails);
    /// state() of slave j but for the force.
    [[nodiscard]] contact::ContactState measure(Index j, const contact::PairPositions& at) const;
    [[nodiscard]] const Mat3& image(Index j, Index i) const { return pair_->image(points_[j].nodes[i]); }
    [[nodiscard]] Vec3 drift(Index j, const Places& from, const Places& to) const;
    /// From the slave's motion and moved(vertex), those of the master's nodes.
    template <class Moved> [[nodiscard]] Vec3 drift(Index j, const Vec3& slave, const Moved& moved) const;

    const ContactPair* pair_;
    std::unique_ptr<contact::Discretisation> discretisation_;
    contact::FacetSearch search_;
    std::shared_ptr<const contact::MasterSurface> master_;
    std::vector<double> inertia_; ///< (slaves) N/m
    std::vector<char> held_;      ///< (slaves) of the current stage
    std::vector<Vec3> lambda_start_;
    Places start_, now_;                        ///< positions, m
    Places tails_start_, tails_;                ///< their last digits; empty: none
    std::vector<Vec3> vertices_, vertex_tails_; ///< of the master surface, now
    contact::FacetTracking tracking_;
    std::vector<contact::ContactPoint> points_;
    std::vector<contact::ContactState> states_; ///< without forces
    std::vector<std::vector<Index>> point_nodes_;
    int facet_changes_ = 0;
};

/// One of each pair of a model.
using ContactEvaluations = std::vector<ContactEvaluation>;
struct Model;
[[nodiscard]] ContactEvaluations contact_evaluations(const Model& model);

} // namespace osculate::model
