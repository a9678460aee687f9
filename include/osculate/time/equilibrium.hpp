#pragma once
/// Equilibrium with contact at the end of one step, as the nonlinear problem KINSOL sees.

#include "osculate/model/constraints.hpp"
#include "osculate/model/contact_evaluation.hpp"
#include "osculate/model/model.hpp"
#include "osculate/model/system_matrix.hpp"
#include "osculate/solve/kinsol_solver.hpp"
#include "osculate/time/body_forces.hpp"
#include "osculate/time/condensed_tangent.hpp"
#include "osculate/time/contact_preconditioner.hpp"
#include "osculate/time/equilibrium_memory.hpp"
#include "osculate/time/linear_solver.hpp"
#include "osculate/time/stage.hpp"

#include <map>
#include <memory>
#include <vector>

namespace osculate::time {

/// Loads and motions at the end of the step.
struct StepLoad {
    std::vector<Vec3> force;               ///< (nodes) external forces, N
    std::vector<Vec3> prescribed;          ///< (nodes) displacement of the held components, local axes, m
    std::vector<FollowerLoad> pressures{}; ///< of this step
};

/// One line of iterations.csv.
struct IterationRecord {
    int iteration = 0;
    double residual = 0; ///< L2 norm over the reference force
    int status_changes = 0, open = 0, stick = 0, slip = 0, facet_changes = 0;
};

/// How contact statuses follow the iterate.
enum class StatusRule {
    natural, ///< named anew by the complementarity functions at every iterate: semismooth Newton
    frozen   ///< as given; the problem is smooth
};

/// F(z) with z = (free displacements, contact forces): equilibrium of every free component and the contact law of every
/// slave node, in the rows SystemMatrix assigns. Contact points are located anew at every z.
///     equilibrium   f(u) - f_ext - f_contact = 0,   f of BodyForces, contact forces as at the end of the step:
///                   f_contact = lambda on the slave, on its masters as ContactPoint says
///     contact law   see contact::Coulomb
class Equilibrium final : public solve::NonlinearProblem, private solve::Preconditioner, private solve::Tangent {
public:
    /// @param dynamics  null in statics; must outlive this object
    Equilibrium(const model::Model& model, const model::Constraints& constraints, const Dynamics* dynamics,
                Timings& timings, int threads, bool follower_pressure = false,
                LinearSolver linear = LinearSolver::automatic);

    /// Opens an attempt over dt: slips and facets start from `state`, loads are those at the end of the step, in dynamics
    /// their weighted mean over the step.
    void begin_attempt(const model::State& state, StepLoad load, double dt);
    /// Ends an attempt: patterns that grew in it stay, or go back to what they were. Nothing else outlives an attempt.
    void commit();
    void rollback();
    /// What the last commit() left for later steps, and the same as if it had left that. Between attempts only.
    [[nodiscard]] EquilibriumMemory memory() const;
    void recall(const EquilibriumMemory& memory);
    /// Statuses for the next solve. With `natural` they hold for the first iterate only, where `force_first` asks for it.
    void set_statuses(std::vector<std::vector<contact::Status>> statuses, StatusRule rule, bool force_first);
    /// The next residual is linear in the displacements about u, (nodes) m, where elements bear a driven motion that has
    /// not spread into the body yet. Of no concern, and not kept, without finite strain.
    void linearise_first_about(const std::vector<Vec3>& u);
    /// Springs in place from the next residual on, see BodyForces; release() takes them away.
    void stabilise(Stabilisation springs);
    void release();
    void set_reference_force(double force) { reference_force_ = force; }

    [[nodiscard]] Index size() const override { return size_; }
    [[nodiscard]] Verdict residual(const double* z, double* F) override;
    [[nodiscard]] const solve::SparseMatrix& jacobian() override;
    [[nodiscard]] solve::Preconditioner* preconditioner() override { return preconditioner_ ? this : nullptr; }
    [[nodiscard]] solve::FactorStatus factorise() override;
    void precondition(const double* r, double* z) override;
    [[nodiscard]] solve::SparseIndex failing_equation() const override { return preconditioner_->failing_equation(); }
    [[nodiscard]] bool factorisable() const override { return may_factorise(model_, linear_); }
    [[nodiscard]] solve::Tangent* tangent() override { return products_ ? this : nullptr; }
    void linearise() override;
    void multiply(const double* x, double* y) override;
    [[nodiscard]] bool solves() const override { return condensed_ && !bodies_.stabilised(); }
    [[nodiscard]] bool solve(const double* b, double* x, double allowed) override;
    [[nodiscard]] int factorisations() const override { return condensed_ ? condensed_->factorisations() : 0; }

    /// z from displacements and contact forces, and the state (time apart) from z.
    [[nodiscard]] Vector unknowns(const std::vector<Vec3>& u, const std::vector<model::ContactHistory>& contact) const;
    [[nodiscard]] model::State state(const Vector& z) const;

    /// Midway between the last two points at which the residual was evaluated: out of a cycle of two.
    [[nodiscard]] Vector midpoint() const { return 0.5 * (last_z_ + before_z_); }
    /// Displacements of z, (nodes) m.
    [[nodiscard]] std::vector<Vec3> displacements(const Vector& z) const;
    /// Statuses at the last residual, and what the complementarity functions say there.
    [[nodiscard]] const std::vector<std::vector<contact::Status>>& statuses() const { return statuses_; }
    [[nodiscard]] std::vector<std::vector<contact::Status>> natural_statuses() const;
    /// Whether the last residual came to rest at the round-off of its own rows: no iterate can say more, see at_round_off().
    [[nodiscard]] bool rests() const { return rests_; }
    /// The z of the last residual.
    [[nodiscard]] const Vector& last_iterate() const { return last_z_; }
    /// Whether z is an equilibrium with these statuses, to the tolerance (of the reference force) or to the round-off of its
    /// rows. Statuses are these afterwards, frozen.
    [[nodiscard]] bool holds(const Vector& z, std::vector<std::vector<contact::Status>> statuses, double tolerance);
    /// Lines of iterations.csv since begin_attempt.
    [[nodiscard]] const std::vector<IterationRecord>& records() const { return records_; }
    /// The last different sets of statuses since begin_attempt, the latest last: a few, for a post-mortem.
    [[nodiscard]] const std::vector<std::vector<std::vector<contact::Status>>>& recent_statuses() const {
        return recent_statuses_;
    }
    /// f_int - f_ext - f_contact at the last residual: what the supports carry, and round-off elsewhere. (nodes) N
    [[nodiscard]] const std::vector<Vec3>& unbalanced() const { return unbalanced_; }
    [[nodiscard]] const std::vector<Vec3>& internal_force() const { return internal_; }
    /// Dead loads of the attempt, in dynamics their mean over the step. (nodes) N
    [[nodiscard]] const std::vector<Vec3>& external_force() const { return load_.force; }
    /// What residuals are measured against, N.
    [[nodiscard]] double reference_force() const { return reference_force_; }
    /// Node whose row holds the largest residual.
    [[nodiscard]] Index worst_node() const { return worst_node_; }
    /// Smallest gap at the last residual, m; infinite where nothing faces anything.
    [[nodiscard]] double least_gap() const;
    /// Element with the least volume left, at the last residual; where it has none there was no residual.
    [[nodiscard]] const model::WorstElement& worst_element() const { return worst_element_; }
    [[nodiscard]] const BodyForces& bodies() const { return bodies_; }
    /// What contact found at the last residual; opened anew by begin_attempt().
    [[nodiscard]] const model::ContactEvaluations& contact() const { return contact_; }
    [[nodiscard]] model::ContactEvaluations& contact() { return contact_; }
    [[nodiscard]] long patterns_built() const { return patterns_built_; }
    [[nodiscard]] const model::Constraints& constraints() const { return constraints_; }

private:
    void linearise(std::size_t p, Index j, contact::VariationForm form, ContactTangent& tangent) const;
    [[nodiscard]] bool evaluate_bodies();
    void unpack(const double* z);
    void fill(double* F);
    void record(const double* F, int status_changes);
    [[nodiscard]] bool cycles(double residual);
    /// u to positions x_ and what their rounding takes off, tail_: x_ + tail_ = X + u to the last digit of u.
    void place();
    /// Whether no component of F, the last residual, is more than round-off of the terms its row is the sum of.
    [[nodiscard]] bool at_round_off(const double* F) const;
    /// What the contact law's row of slave j of pair p is the sum of, N, local axes.
    [[nodiscard]] Vec3 law_terms(std::size_t p, Index j) const;
    /// Whether slave j of pair p has a contact partner and bears on it.
    [[nodiscard]] bool reaches(std::size_t p, Index j) const;
    [[nodiscard]] SoftContact soften(std::size_t p, Index j) const;
    void linearise_bodies();
    void cover_patches();
    [[nodiscard]] Mat3 symmetry_directions(Index node) const;

    const model::Model& model_;
    const model::Constraints& constraints_;
    Timings& timings_;
    int threads_;
    LinearSolver linear_;
    BodyForces bodies_;
    model::ContactEvaluations contact_; ///< of the attempt
    Index size_ = 0;
    std::vector<Index> first_coupling_; ///< (pairs + 1)
    std::unique_ptr<model::SystemMatrix> matrix_;
    std::unique_ptr<ContactPreconditioner> preconditioner_; ///< none where the tangent is symmetric
    std::unique_ptr<CondensedTangent> condensed_;           ///< where bodies are linear
    bool products_ = false;                                 ///< the tangent goes by what it does
    std::vector<BearingContact> bearing_;
    std::vector<Mat3> open_laws_;                 ///< (couplings) D of nodes that bear on nothing
    std::vector<model::Coupling> kept_couplings_; ///< of matrix_ at the last commit
    long kept_patterns_ = 0;                      ///< patterns_built_ then
    StepLoad load_;
    double reference_force_ = 1;

    std::vector<Vec3> u_, x_, internal_, unbalanced_;
    std::vector<Vec3> tail_;                                ///< see place()
    std::vector<Vec3> product_u_, product_f_, product_law_; ///< scratch of multiply()
    std::vector<Vector> product_on_;
    std::vector<Vec3> linear_about_; ///< of the next residual; empty: exact
    bool linearised_ = false;        ///< the last residual was, and the tangent belongs to it
    std::vector<std::vector<Vec3>> lambda_;
    std::vector<std::vector<contact::Status>> statuses_;
    StatusRule rule_ = StatusRule::natural;
    bool force_next_ = false;
    std::vector<ContactTangent> tangents_; ///< a batch of jacobian()
    std::vector<IterationRecord> records_;
    std::vector<std::vector<std::vector<contact::Status>>> recent_statuses_;
    std::map<std::size_t, std::pair<int, double>> visits_; ///< contact configuration -> times seen, least residual
    std::size_t last_configuration_ = 0;
    double best_ = 0;          ///< least residual since set_statuses()
    int idle_ = 0;             ///< iterates since
    bool rests_ = false;       ///< see rests()
    Vector last_z_, before_z_; ///< of the last two residuals
    Index worst_node_ = -1;
    model::WorstElement worst_element_;                        ///< at the last residual
    bool stale_preconditioner_ = false, stale_matrix_ = false; ///< the tangent of the bodies has moved on
    long patterns_built_ = 0;
};

} // namespace osculate::time
