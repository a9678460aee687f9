#pragma once
/// One contact pair: slave nodes, or the slave facets around them, against a master surface; constraints exact.

#include "osculate/contact/contact_point.hpp"
#include "osculate/contact/coulomb.hpp"
#include "osculate/contact/master_surface.hpp"
#include "osculate/contact/mirror.hpp"
#include "osculate/contact/mortar.hpp"
#include "osculate/contact/search.hpp"
#include "osculate/core/timing.hpp"
#include "osculate/mesh/half_edge_surface.hpp"

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace osculate::model {

/// What a pair carries from one accepted step to the next.
struct ContactHistory {
    std::vector<Vec3> lambda;            ///< (slaves) contact force on each slave node, N, global components
    std::vector<contact::Status> status; ///< (slaves)
    std::vector<Index> facet;            ///< (slaves) temporary contact facet, -1 not searched yet
};

/// Slave nodes of a pair with what belongs to each.
struct SlaveNodes {
    std::vector<Index> node;         ///< global
    std::vector<double> area;        ///< tributary area in the reference configuration, m^2
    std::vector<double> stiffness;   ///< c of the complementarity function, N/m
    std::vector<mesh::Facet> facets; ///< slave surface, global nodes
    std::vector<Mat3> in_plane{};    ///< projectors on the symmetry planes a node lies on; empty: there are none
};

/// What the vertices of a master surface are: nodes, or mirror images of nodes.
struct MasterNodes {
    std::vector<Index> node;    ///< (vertices) global
    std::vector<Index> image{}; ///< (vertices) into images; empty: every vertex is its node
    std::vector<contact::Image> images{contact::Image{}};
    std::vector<double> thickness{}; ///< (vertices) of the body behind, m; empty: not asked for
};

enum class Discretisation { node, mortar };

struct ContactOptions {
    double friction = 0;      ///< Coulomb's mu
    double hysteresis = 0.03; ///< of the facet size, see contact::FacetSearch::track
    int changes_before_latch =
        4; ///< facet changes of a node within one attempt, after which it stays: it is on an edge
    double closing_tolerance = 0.02; ///< of the facet size: how near counts as touching before anything is in contact
    Discretisation discretisation = Discretisation::node;
};

class ContactTerm {
public:
    using MatrixX3 = contact::MatrixX3;

    /// @param X            reference positions of all nodes
    /// @param master_nodes what the vertices of `surface` are
    /// @param smooth       for mortar: surface through the slave nodes, its vertices' nodes among them; null: their facets
    ContactTerm(std::string name, const std::vector<Vec3>& X, SlaveNodes slaves,
                std::unique_ptr<mesh::HalfEdgeSurface> surface, MasterNodes master_nodes,
                std::unique_ptr<contact::MasterSurface> master, const ContactOptions& options,
                const contact::SmoothSlave* smooth = nullptr);

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] Index size() const { return static_cast<Index>(slaves_.node.size()); }
    [[nodiscard]] const SlaveNodes& slaves() const { return slaves_; }
    [[nodiscard]] const mesh::HalfEdgeSurface& surface() const { return *surface_; }
    [[nodiscard]] const contact::MasterSurface& master() const { return *master_; }
    [[nodiscard]] const std::vector<Index>& master_nodes() const { return master_nodes_.node; }
    [[nodiscard]] const ContactOptions& options() const { return options_; }
    /// Least thickness of the body behind a facet's vertices, m; infinite where none was given.
    [[nodiscard]] double thickness(Index facet) const;
    /// The smallest of all facet sizes and thicknesses, m: motions well below it leave no doubt about the side of a node.
    [[nodiscard]] double finest() const { return finest_; }
    /// Positions of the master's vertices, mirror images among them.
    [[nodiscard]] std::vector<Vec3> vertices(const std::vector<Vec3>& x) const;
    /// Whether the master has mirror images: forces on them fold back onto its nodes.
    [[nodiscard]] bool mirrored() const { return !master_nodes_.image.empty(); }
    /// The vertex that stands for the node itself of which `vertex` may be an image.
    [[nodiscard]] Index own_vertex(Index vertex) const { return own_vertex_.empty() ? vertex : own_vertex_[vertex]; }
    [[nodiscard]] ContactHistory initial_history() const;

    /// Opens a step at nodal positions x: slips are measured from here. Nodes that are not closed are searched anew over
    /// the whole surface. Returns nothing to undo: everything it sets is scratch of the attempt.
    void begin_step(const std::vector<Vec3>& x, const ContactHistory& history, Timings& timings, int threads);
    /// Evaluates every slave node at positions x, following each from its last facet.
    void evaluate(const std::vector<Vec3>& x, Timings& timings, int threads);

    /// Adapts the master to the positions x of an accepted step; returns how many patches were fitted anew.
    Index refresh(const std::vector<Vec3>& x) { return master_->refresh(vertices(x)); }

    /// See contact::MasterSurface.
    [[nodiscard]] std::vector<contact::RefittedPatch> refitted() const { return master_->refitted(); }
    [[nodiscard]] bool refit(const std::vector<contact::RefittedPatch>& patches) { return master_->refit(patches); }

    [[nodiscard]] const contact::ContactPoint& point(Index j) const { return points_[j]; }
    /// Of all slave nodes with a contact partner at the last evaluation, m; infinite where none has one.
    [[nodiscard]] double least_gap() const;
    /// Closest point of slave j on its facet at the last evaluation, whether or not there is contact.
    [[nodiscard]] const contact::FacetHit& hit(Index j) const { return hits_[j]; }
    /// With mortar: gap of slave node j itself at the positions of the last evaluate(), where its facets overlap none of the
    /// master's, m; infinite where they do, where it is not above or below the master, and without mortar.
    [[nodiscard]] double unseen_gap(Index j, const std::vector<Vec3>& x) const;
    /// Global nodes of the patch of slave j, in the order of point(j).weights.
    [[nodiscard]] const std::vector<Index>& point_nodes(Index j) const { return point_nodes_[j]; }
    /// Global nodes of the patch that the facet of slave j would use, whether or not there is contact.
    [[nodiscard]] std::vector<Index> patch_nodes(Index facet) const;
    /// Displacement of slave j relative to the master between two displacement fields, at its current contact point, m.
    [[nodiscard]] Vec3 drift(Index j, const std::vector<Vec3>& from, const std::vector<Vec3>& to) const;
    /// The same since the step began, to positions x of all nodes.
    [[nodiscard]] Vec3 drift(Index j, const std::vector<Vec3>& x) const { return drift(j, x_start_, x); }
    /// What the gap lacks, m, where the positions of the last evaluate() lack `tails` (nodes), m, their last digits: so small
    /// that first variations are exact.
    [[nodiscard]] double gap_rounded_off(Index j, const std::vector<Vec3>& tails) const;
    /// What the law needs to know: without friction no drift.
    [[nodiscard]] contact::ContactState state(Index j, const std::vector<Vec3>& x, const Vec3& lambda) const;
    /// c of the complementarity function of slave j, N/m: stiffness and, in dynamics, what inertia adds to it.
    [[nodiscard]] double stiffness(Index j) const { return slaves_.stiffness[j] + inertia_[j]; }
    /// Inertia of the slave nodes, N/m: mass over the square of the time step, more or less.
    void set_inertia(std::vector<double> inertia) { inertia_ = std::move(inertia); }
    /// Declares which slave nodes are held or driven along some direction: their stick is elastic, see contact::Coulomb.
    void hold(std::vector<char> held) { held_ = std::move(held); }
    [[nodiscard]] contact::Coulomb law(Index j) const;
    /// Opens a round of vary() at the positions x of the last evaluate(), for the slave nodes that are `wanted`.
    void prepare_variations(const std::vector<Vec3>& x, std::span<const char> wanted, int threads);
    /// Variations of point j, evaluated anew at the positions of the last evaluate().
    void vary(Index j, const std::vector<Vec3>& x, contact::ContactVariation& variation) const;
    /// Derivative of the drift d of state() with respect to y = (slave, masters), 3 x 3+3n.
    void drift_variation(Index j, const std::vector<Vec3>& x, const contact::ContactVariation& variation,
                         Matrix& dd) const;
    /// Force on master node i of the patch of slave j: p_i (lambda . n) - Phi_i (lambda - n n . lambda).
    [[nodiscard]] Vec3 master_force(Index j, Index i, const Vec3& lambda) const;
    /// How many of point_nodes(j) carry force: the first ones. The others only bear on the gap.
    [[nodiscard]] Index carriers(Index j) const;
    /// Its derivatives over the m masters that carry force: (3m x 3) by lambda, (3m x 3+3n) by y.
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

    [[nodiscard]] const std::vector<Index>& facets() const { return facet_; }
    /// Facet changes at the last evaluation.
    [[nodiscard]] int facet_changes() const { return facet_changes_; }

private:
    /// Linear part of the image that vertex i of the patch of slave j is.
    [[nodiscard]] const Mat3& image(Index j, Index i) const;
    /// Positions of the slave nodes.
    [[nodiscard]] std::vector<Vec3> slave_positions(const std::vector<Vec3>& x) const;
    void evaluate_nodes(const std::vector<Vec3>& x, int threads);
    /// Change of the forces on the master nodes, (3m), from those of normal, weights (m) and pressing (3m).
    void turn_forces(Index j, const Vec3& lambda, const Vec3& dn, const double* dweights, const double* dpressing,
                     double* df) const;

    std::string name_;
    SlaveNodes slaves_;
    std::unique_ptr<mesh::HalfEdgeSurface> surface_;
    MasterNodes master_nodes_;
    std::vector<Index> own_vertex_; ///< (vertices) empty without images
    std::unique_ptr<contact::MasterSurface> master_;
    std::unique_ptr<contact::Mortar> mortar_; ///< null: contact at the slave nodes
    contact::FacetSearch search_;
    ContactOptions options_;
    double finest_ = 0;

    std::vector<double> inertia_; ///< (slaves) N/m
    std::vector<char> held_;      ///< (slaves) of the current stage
    // scratch of an attempt
    std::vector<Vec3> lambda_start_;
    std::vector<Vec3> x_start_;  ///< all nodes
    std::vector<Vec3> vertices_; ///< master surface now
    std::vector<Index> facet_;
    std::vector<Index> side_;  ///< ContactPoint::side at the last evaluation
    std::vector<int> changes_; ///< facet changes of each slave in this attempt
    std::vector<contact::FacetHit> hits_;
    std::vector<contact::ContactPoint> points_;
    std::vector<std::vector<Index>> point_nodes_;
    int facet_changes_ = 0;
};

} // namespace osculate::model
