#pragma once
/// Equilibrium with contact at the end of one step, as a nonlinear problem for KINSOL.

#include "osculate/equilibrium/body_term.hpp"
#include "osculate/equilibrium/contact_term.hpp"
#include "osculate/equilibrium/cycle_watch.hpp"
#include "osculate/equilibrium/equilibrium_tangent.hpp"
#include "osculate/equilibrium/friction_step.hpp"
#include "osculate/equilibrium/rigid_term.hpp"
#include "osculate/linear/constraints.hpp"
#include "osculate/linear/unknowns.hpp"
#include "osculate/model/model.hpp"
#include "osculate/solve/kinsol_solver.hpp"

#include <vector>

namespace osculate::equilibrium {

/// One line of iterations.csv.
struct IterationRecord {
    int iteration = 0;
    double residual = 0; ///< L2 norm, divided by the reference force
    int status_changes = 0, open = 0, stick = 0, slip = 0, facet_changes = 0;
};

/// F(z) with z as in Unknowns: equilibrium of every free component and the contact law of every slave node. It is the
/// sum of its terms; contact points are located again at every z.
///     equilibrium   f(u) - f_ext - f_contact = 0,   f of BodyForces, contact forces as at the end of the step
class Equilibrium final : public solve::NonlinearProblem {
public:
    /// @param pairs     in force during its attempts
    /// @param dynamics  null in statics; must outlive this object; its integrator may change between attempts
    Equilibrium(const model::Model& model, model::ContactPairs pairs, const linear::Constraints& constraints,
                const Dynamics* dynamics, const TangentChoice& choice, Timings& timings, int threads,
                bool follower_pressure = false);

    /// Opens an attempt over dt: slips and facets start from `state`; loads are those at the end of the step, in
    /// dynamics their weighted mean over the step.
    void begin_attempt(const model::State& state, StepLoad load, double dt);
    /// Ends an attempt: keeps or discards the growth of patterns during it. Nothing else is kept after an attempt.
    void commit() { tangent_.commit(); }
    void rollback() { tangent_.rollback(); }
    /// Data that the last commit() kept for later steps; recall() restores it. Call only between attempts.
    [[nodiscard]] EquilibriumMemory memory() const { return tangent_.memory(); }
    void recall(const EquilibriumMemory& memory) { tangent_.recall(memory); }
    /// What another equilibrium with the same stiffness of the bodies may go on from, see Condensation::go_on_from().
    [[nodiscard]] std::shared_ptr<const linear::CondensedTangent> kept_condensation() const {
        return tangent_.kept_condensation();
    }
    void go_on_from(const std::shared_ptr<const linear::CondensedTangent>& last) { tangent_.go_on_from(last); }
    /// Begins again at the start of the step: facets are as they were there.
    void forget_paths() { contact_.forget_paths(); }
    /// Whether solves stop as soon as they come back to statuses or gain nothing for a while, since a rung that needs no
    /// luck follows.
    void set_impatient(bool impatient) { cycles_.set_impatient(impatient); }
    /// Whether solves end where GMRES with multigrid fails instead of factorising the whole tangent, since a rung that needs less
    /// follows.
    void set_sparing(bool sparing) { sparing_ = sparing; }
    /// Statuses for the next solve, see ContactTerm.
    void set_statuses(Statuses statuses, StatusRule rule, bool force_first);
    /// Makes the next residual linear in the displacements about u, (nodes) m: for elements under a driven motion that
    /// has not spread into the body yet. No effect without nonlinear elements.
    void linearise_first_about(const Field& u) { bodies_.linearise_next_about(u); }
    /// Adds springs from the next residual on, see BodyForces; release() removes them.
    void stabilise(Stabilisation springs);
    void release();
    /// Whether the geometry of contact can be held; holds that of the last residual until let_go_of_contact() or begin_attempt(). See
    /// ContactTerm::hold_geometry().
    [[nodiscard]] bool can_hold_contact() const { return contact_.can_hold_geometry(); }
    void hold_contact() { contact_.hold_geometry(); }
    void let_go_of_contact() { contact_.let_go(); }
    /// See ContactTerm::geometry_error(), at the last residual.
    [[nodiscard]] double contact_geometry_error() const { return contact_.geometry_error(at_); }
    /// See FrictionStep::advance(), from the last residual.
    [[nodiscard]] bool advance_friction(Vector& z);
    void set_reference_force(double force) { reference_force_ = force; }

    [[nodiscard]] Index size() const override { return unknowns_.size(); }
    [[nodiscard]] Verdict residual(const ConstVectorRef& z, VectorRef F) override;
    [[nodiscard]] const solve::SparseMatrix& jacobian() override { return tangent_.jacobian(); }
    [[nodiscard]] solve::Preconditioner* preconditioner() override {
        return tangent_.preconditions() ? &tangent_ : nullptr;
    }
    [[nodiscard]] Slices* slices() override { return tangent_.slices(); }
    [[nodiscard]] bool factorisable() const override { return factorisable_ && !(sparing_ && multigrid_); }
    [[nodiscard]] solve::Tangent* tangent() override { return tangent_.by_products() ? &tangent_ : nullptr; }

    /// See EquilibriumTangent, at the last residual, and ContactTerm::add_transposed_of_start().
    void linearise_transposed() { tangent_.linearise_transposed(); }
    void add_transposed(const Weights& of, Weights& by) { tangent_.add_transposed(of, by); }
    void unpack_rows(const Vector& rows, Weights& of) const { tangent_.unpack_rows(rows, of); }
    [[nodiscard]] bool solve_transposed(const Weights& b, Vector& w, Weights& of, double tolerance) {
        return tangent_.solve_transposed(b, w, of, tolerance);
    }
    /// Adds the weights that the state at the step's start has by weights of residuals, and by those of velocities and accelerations
    /// at its end, all at fixed unknowns.
    void add_transposed_of_start(const Weights& of, const StateWeights& end, StateWeights& start) const {
        contact_.add_transposed_of_start(of, start);
        if (bodies().dynamic()) bodies().add_transposed_of_start(displacements(last_z_), of.nodes, end, start);
    }

    /// z from displacements and contact forces, and the state (without time) from z.
    [[nodiscard]] Vector unknowns(const Field& u, const std::vector<model::ContactHistory>& contact) const;
    [[nodiscard]] model::State state(const Vector& z) const;
    /// Displacements of z, (nodes) m.
    [[nodiscard]] Field displacements(const Vector& z) const;

    /// What restored() makes unknowns of again: where processes solve in slices, each keeps its own.
    [[nodiscard]] Vector kept(const Vector& z) const;
    /// Collective where processes solve in slices.
    [[nodiscard]] Vector restored(const Vector& kept) const;
    /// Midpoint of the last two points at which the residual was evaluated, to leave a cycle of two. Collective likewise.
    [[nodiscard]] Vector midpoint() const { return 0.5 * (last_z_ + restored(before_)); }
    /// Statuses at the last residual, and statuses according to the complementarity functions there.
    [[nodiscard]] const Statuses& statuses() const { return contact_.statuses(); }
    [[nodiscard]] Statuses natural_statuses() const { return contact_.natural_statuses(); }
    /// Whether the last residual stagnated at the round-off of its own rows, so that no iterate can improve it, see
    /// at_round_off().
    [[nodiscard]] bool rests() const { return rests_; }
    /// The z of the last residual.
    [[nodiscard]] const Vector& last_iterate() const { return last_z_; }
    /// Whether z is an equilibrium with these statuses, to the tolerance (relative to the reference force) or to the
    /// round-off of its rows. Sets and freezes these statuses.
    [[nodiscard]] bool holds(const Vector& z, Statuses statuses, double tolerance);
    /// Lines of iterations.csv since begin_attempt.
    [[nodiscard]] const std::vector<IterationRecord>& records() const { return records_; }
    /// The last few different sets of statuses since begin_attempt, the latest last, for diagnosis of a failure.
    [[nodiscard]] const std::vector<Statuses>& recent_statuses() const { return cycles_.recent(); }
    /// f_int - f_ext - f_contact at the last residual: the forces of the supports, and round-off elsewhere. (nodes) N;
    /// those on the meshes of rigid bodies act at the bodies' own nodes
    [[nodiscard]] const Field& unbalanced() const { return unbalanced_; }
    [[nodiscard]] const Field& internal_force() const { return bodies_.internal_force(); }
    /// Dead loads of the attempt, in dynamics their mean over the step. (nodes) N
    [[nodiscard]] const Field& external_force() const { return loads_.force(); }
    /// Reference force for residuals, N.
    [[nodiscard]] double reference_force() const { return reference_force_; }
    /// Node of the row with the largest residual.
    [[nodiscard]] Index worst_node() const { return worst_node_; }
    /// Smallest gap at the last residual, m; infinite if no slave node faces a master.
    [[nodiscard]] double least_gap() const { return contact_.least_gap(); }
    /// Element with the least det F at the last residual; if this is not positive, there was no residual.
    [[nodiscard]] const model::WorstElement& worst_element() const { return bodies_.worst_element(); }
    [[nodiscard]] const BodyForces& bodies() const { return bodies_.bodies(); }
    /// Contact of all pairs at the last residual; reset by begin_attempt().
    [[nodiscard]] const model::ContactEvaluations& contact() const { return contact_.evaluations(); }
    [[nodiscard]] model::ContactEvaluations& contact() { return contact_.evaluations(); }
    [[nodiscard]] long patterns_built() const { return tangent_.patterns_built(); }
    [[nodiscard]] const linear::Constraints& constraints() const { return constraints_; }
    /// Rigid bodies at the last residual; null: the model has none.
    [[nodiscard]] const RigidTerm* rigid() const { return rigid_.get(); }

    /// Adds the arrays of the attempt that all processes hold.
    void add_replicas(Replicas& replicas) const {
        replicas.add(prescribed_);
        replicas.add(loads_.force());
    }

private:
    [[nodiscard]] std::vector<Term*> list_of_terms();
    void unpack();
    void fill(VectorRef F);
    void record(const ConstVectorRef& F);
    /// Computes positions x from u, and their rounding errors.
    void place();
    /// Whether every component of F, the last residual, is within the round-off of the summands of its row.
    [[nodiscard]] bool at_round_off(const ConstVectorRef& F) const;

    const model::Model& model_;
    const model::ContactPairs pairs_;
    const linear::Constraints& constraints_;
    linear::Unknowns unknowns_;
    Timings& timings_;
    BodyTerm bodies_;
    LoadTerm loads_;
    ContactTerm contact_;
    std::unique_ptr<RigidTerm> rigid_; ///< null: there are no rigid bodies
    std::vector<Term*> terms_;
    Iterate at_; ///< of the last residual
    EquilibriumTangent tangent_;
    std::unique_ptr<FrictionStep> friction_; ///< null: not needed yet
    bool factorisable_, multigrid_, sparing_ = false;
    Field prescribed_; ///< StepLoad::prescribed of the attempt
    double reference_force_ = 1;
    Field unbalanced_;
    CycleWatch cycles_;
    std::vector<IterationRecord> records_;
    bool rests_ = false;     ///< see rests()
    Vector last_z_, before_; ///< of the last residual, and, kept(), of the one before
    Index worst_node_ = -1;
};

} // namespace osculate::equilibrium
