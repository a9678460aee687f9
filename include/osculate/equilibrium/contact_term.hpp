#pragma once
/// Contact of all pairs as a term of the residual: forces on slaves and masters, and the rows of the contact laws.

#include "osculate/core/timing.hpp"
#include "osculate/equilibrium/contact_tangent.hpp"
#include "osculate/equilibrium/dynamics.hpp"
#include "osculate/equilibrium/term.hpp"
#include "osculate/linear/dependence.hpp"
#include "osculate/model/contact_evaluation.hpp"

#include <vector>

namespace osculate::equilibrium {

using Statuses = std::vector<std::vector<contact::Status>>; ///< (pairs) (slaves)

/// How contact statuses follow the iterate.
enum class StatusRule {
    natural, ///< determined by the complementarity functions at every iterate: semismooth Newton
    frozen   ///< fixed as given; the problem is smooth
};

/// Contact of one slave node, linear in the motion of its nodes and in its force, in the local axes (n, t_1, t_2):
///     u = w + A dy = (gap, tangential drift),   forces on the masters F r for the force r on the slave.
/// If stick is elastic, its law holds for the tangential part of u + compliance (r - anchor); if the contact yields, for the
/// gap + normal compliance r_n. Friction is then r with drag times the tangential drift added.
struct LinearisedContact {
    Index coupling = -1, slave = -1;
    std::span<const Index> masters;               ///< (n) global
    Mat3 axes = Mat3::Identity();                 ///< columns n, t_1, t_2
    Vec3 w = Vec3::Zero();                        ///< m
    double compliance = 0, normal_compliance = 0; ///< m/N
    Vec3 anchor = Vec3::Zero();                   ///< N
    Matrix A;                                     ///< (3 x 3+3n)
    contact::MatrixX3 F;                          ///< (3m x 3), of the first m masters
    double friction = 0;
    double drag = 0; ///< force against sliding beside friction, over the drift, N/m
};

///     forces        lambda on the slave, on its masters as ContactPoint says
///     contact law   see contact::Coulomb
class ContactTerm final : public Term {
public:
    /// @param unknowns  must outlive this object, like the other references
    ContactTerm(const model::ContactPairs& pairs, const linear::Constraints& constraints,
                const linear::Unknowns& unknowns, Timings& timings, int threads);

    /// Shares evaluation and products out among processes; all calls but const ones are collective then.
    void share_out(Ranks& ranks);
    /// Says that nodes depend on others. It must outlive this object.
    void use(const linear::Dependence& dependence) { dependence_ = &dependence; }
    /// Sets the statuses for the next solve. With `natural` they are used only at the next iterate, and only if
    /// `force_first`.
    void set_statuses(Statuses statuses, StatusRule rule, bool force_first);
    [[nodiscard]] const Statuses& statuses() const { return statuses_; }
    /// Number of statuses that the last evaluate() changed.
    [[nodiscard]] int status_changes() const { return status_changes_; }
    /// Statuses according to the complementarity functions at the last evaluate().
    [[nodiscard]] Statuses natural_statuses() const;
    /// Sets the inertia of the slave nodes from the bodies' stiffness, see ContactEvaluation::set_inertia.
    void set_inertia(const BodyForces& bodies);
    /// Steps are dynamic.
    void set_dynamics(const Dynamics& dynamics) { dynamics_ = &dynamics; }
    [[nodiscard]] const model::ContactEvaluations& evaluations() const { return evaluations_; }
    [[nodiscard]] model::ContactEvaluations& evaluations() { return evaluations_; }
    /// Smallest gap, m; infinite if no slave node faces a master.
    [[nodiscard]] double least_gap() const;
    /// See model::ContactEvaluation::forget_path().
    void forget_paths() {
        for (model::ContactEvaluation& evaluation : evaluations_) evaluation.forget_path();
    }
    /// Whether all pairs can hold their geometry; holds that of the last evaluate(), and lets it go, see
    /// model::ContactEvaluation::hold_geometry().
    [[nodiscard]] bool can_hold_geometry() const;
    void hold_geometry();
    void let_go();
    /// How far the geometry of an iterate is from the one that is held, in facet sizes: gaps of closed nodes, depths of open
    /// ones, and a tenth of the way that closed nodes have moved along their masters since.
    [[nodiscard]] double geometry_error(const Iterate& at) const;
    /// Writes the contact forces of a state into z.
    void pack(const std::vector<model::ContactHistory>& contact, VectorRef z) const;
    /// At the last linearise(): slave nodes in contact with a master, by coupling; and, for the others, derivatives of
    /// the law by the contact force, (couplings).
    [[nodiscard]] const std::vector<linear::BearingContact>& bearing() const { return bearing_; }
    [[nodiscard]] const std::vector<Mat3>& open_laws() const { return open_laws_; }

    /// Linearises contact at the last evaluate() for the slave nodes that are closed, carry a force, or are nearer to the
    /// master than `reach` facet sizes.
    [[nodiscard]] std::vector<LinearisedContact> linearise_near(double reach);

    [[nodiscard]] std::string_view name() const override { return "contact"; }
    bool begin(const model::State& state, const Iterate& at, const StepLoad& load, double dt) override;
    [[nodiscard]] bool evaluate(const Iterate& at) override;
    void add_forces(Field& f) const override;
    [[nodiscard]] Index write_rows(VectorRef F) const override;
    void add_magnitudes(const Iterate& at, Field& sums) const override;
    [[nodiscard]] bool rows_within(const Iterate& at, const Field& sums, const ConstVectorRef& F,
                                   double share) const override;
    void linearise(const Iterate& at) override;
    void add_product(const Direction& d, Field& f, VectorRef y) override;
    void linearise_transposed(const Iterate& at) override;
    void add_transposed(const Weights& of, Weights& by) const override {
        add_transposed(of.nodes, of.couplings, by.nodes, by.couplings);
    }
    void add_transposed(const Field& of_nodes, const std::vector<Vec3>& of_laws, Field& by_nodes,
                        std::vector<Vec3>& by_forces) const;
    /// The same by displacements and contact forces at the start of the step, of which slips are measured and elastic stick begins.
    /// Only the laws depend on them.
    void add_transposed_of_start(const Weights& of, StateWeights& by) const;
    [[nodiscard]] bool add_pattern(std::vector<linear::Coupling>& couplings) const override;
    void add_derivatives(linear::SystemMatrix& matrix) override;
    void add_soft(std::vector<linear::SoftContact>& soft) const override;
    void complete(const ConstVectorRef& z, model::State& state) const override;

private:
    [[nodiscard]] Vec3 force(const ConstVectorRef& z, Index coupling) const;
    /// Sum of the absolute values of the summands of the contact law's row of slave j of pair p, N, local axes.
    [[nodiscard]] Vec3 law_magnitudes(const Iterate& at, std::size_t p, Index j) const;
    [[nodiscard]] contact::ContactResidual law(std::size_t p, Index j) const;
    /// Whether slave j of pair p has a contact partner and is closed or carries a contact force.
    [[nodiscard]] bool reaches(std::size_t p, Index j) const;
    void prepare_variations(std::size_t p, bool all);
    /// Fills in bearing_ and open_laws_ from tangents_.
    void list_bearing();
    void linearise(std::size_t p, Index j, contact::VariationForm form, ContactTangent& tangent) const;
    /// Of a slave node that does not reach its master, or whose derivatives another process has.
    void linearise_law(std::size_t p, Index j, ContactTangent& tangent) const;
    /// Takes the products of other processes' contacts from them.
    void exchange_products();
    [[nodiscard]] linear::SoftContact soften(std::size_t p, Index j) const;
    /// Projector on the directions in which symmetry planes hold a node: no contact force acts along these directions.
    [[nodiscard]] Mat3 symmetry_directions(Index node) const;

    const model::ContactPairs& pairs_;
    const linear::Constraints& constraints_;
    const linear::Unknowns& unknowns_;
    Timings& timings_;
    int threads_;
    const Dynamics* dynamics_ = nullptr;             ///< null: steps are static
    const linear::Dependence* dependence_ = nullptr; ///< null: no node depends on others
    model::ContactEvaluations evaluations_;          ///< of the attempt
    std::vector<Index> first_;                       ///< (pairs + 1) couplings
    std::vector<std::vector<Vec3>> lambda_;          ///< (pairs) (slaves) N, global
    Statuses statuses_;
    StatusRule rule_ = StatusRule::natural;
    bool force_next_ = false;
    int status_changes_ = 0;
    std::vector<ContactTangent> tangents_; ///< by coupling for products; one batch for a matrix
    std::vector<linear::BearingContact> bearing_;
    Ranks* ranks_ = nullptr;         ///< processes that share the run; null: one
    std::vector<int> bearing_owner_; ///< (bearing_) rank; empty: one process
    std::vector<Mat3> open_laws_;
    std::vector<Vec3> product_law_; ///< scratch of add_product()
    std::vector<Vector> product_on_;
    std::vector<double> exchanged_; ///< scratch of exchange_products()
};

} // namespace osculate::equilibrium
