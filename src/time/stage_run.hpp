#pragma once
/// One stage of a run, step by step: prepare, trial, solve, judge; then commit or reject.

#include "osculate/equilibrium/equilibrium.hpp"
#include "osculate/model/general_contact.hpp"
#include "osculate/solve/kinsol_solver.hpp"
#include "osculate/time/checkpoint.hpp"
#include "osculate/time/collision_check.hpp"
#include "osculate/time/finite_check.hpp"
#include "osculate/time/solve_ladder.hpp"
#include "time/run_context.hpp"
#include "time/step_evidence.hpp"

#include <memory>
#include <optional>

namespace osculate::time {

/// An attempt at a step.
struct StepAttempt {
    double time = 0, dt = 0; ///< at its end, s
    double proposed = 0;     ///< dt where no time to hit were near
    bool on_target = false;
    Field force;                    ///< (nodes) dead loads of the step's equations, N; of dynamic steps alone
    Vector z;                       ///< start values, the last iterate afterwards
    equilibrium::Statuses statuses; ///< to start from
    bool forced = false;            ///< contact made by hand, see starting_statuses()
    LadderOptions ladder;
    double reference_force = 1; ///< N, before a solve that stagnates raises it

    StepEvidence evidence;
    Decision decision;
    LadderResult result;
    int iterations = 0;
    model::State next; ///< where solved
    Ledger ledger;
    std::optional<NotFinite> not_finite;
    Index worst_in_time = -1;                    ///< node of StepEvidence::local_error
    const contact::AuditResult* audit = nullptr; ///< null: there was none
    double uncovered = 0; ///< largest motion of a node, m, where bodies came near that no pair joins; 0: all is covered
};

/// What solves and judges steps, for one list of contact pairs.
struct Machinery {
    equilibrium::TangentChoice choice;
    equilibrium::Equilibrium equilibrium;
    solve::KinsolSolver solver;
    CollisionCheck collisions;
    bool located = false; ///< whether collisions has begun the step

    /// @param dynamics  of the attempts; null in statics
    Machinery(RunContext& context, const Stage& stage, const equilibrium::Dynamics* dynamics,
              const linear::Constraints& constraints, const model::State& state);
};

class StageRun {
public:
    /// @param progress  moved on by every accepted step
    /// @param from      where to go on in the stage; null: at its start
    StageRun(RunContext& context, const Stage& stage, Progress& progress, StepObserver& observer,
             const Checkpoint* from);
    void run();

private:
    [[nodiscard]] StepAttempt prepare();
    /// What all processes of a machine hold, in the stage and in the attempt.
    void keep_stage_once() const;
    void keep_attempt_once(const StepAttempt& attempt) const;
    [[nodiscard]] bool wants_trial(const StepAttempt& attempt) const;
    /// With the statuses known at the start; its solution is where the equilibrium with contact starts from.
    void trial(StepAttempt& attempt);
    void solve(StepAttempt& attempt);
    void gather_evidence(StepAttempt& attempt);
    void gather_dynamic_evidence(StepAttempt& attempt);
    [[nodiscard]] const equilibrium::Dynamics* dynamics() const { return dynamics_ ? &*dynamics_ : nullptr; }
    void commit(StepAttempt& attempt);
    /// Takes the runs beside this one over an accepted step.
    void lead(const StepAttempt& attempt);
    void reject(const StepAttempt& attempt);
    /// Its row of the diary.
    [[nodiscard]] Attempt row_of(const StepAttempt& attempt);
    [[nodiscard]] Checkpoint checkpoint() const;
    /// Looks for the pairs of general contact anew, from the accepted state on.
    /// @param expected  largest motion of a node in the next step, m
    void find_pairs(double expected, std::vector<model::WatchedNode> watched = {});
    /// The same where an attempt has moved nodes out of the scope of the pairs: it is repeated if there are others.
    void look_farther(StepAttempt& attempt);
    /// The same where the audit rejects an attempt for places that contact does not watch yet: it is repeated if they are near.
    void watch(StepAttempt& attempt);
    /// Makes a list of pairs that of the state.
    void install(std::vector<model::ContactHistory> contact, model::ContactScope scope);
    [[nodiscard]] equilibrium::Equilibrium& equilibrium() { return machinery_->equilibrium; }
    [[nodiscard]] const equilibrium::Equilibrium& equilibrium() const { return machinery_->equilibrium; }
    /// Examines the attempt, tells the observer and throws RunFailure.
    [[noreturn]] void give_up(const StepAttempt& attempt);

    RunContext& context_;
    const Stage& stage_;
    Progress& progress_;
    StepObserver& observer_;
    linear::Constraints constraints_;
    std::optional<equilibrium::Dynamics> dynamics_; ///< of the attempt; none in statics
    std::unique_ptr<Machinery> machinery_;          ///< for the pairs of the state
    std::optional<CentreMasses> centres_;           ///< of dynamic stages
    std::vector<double> targets_;                   ///< times to hit
    [[nodiscard]] bool bounded() const;             ///< whether interpenetration is
    // of one step
    int repeats_ = 0;
    double lost_per_second_ = 0; ///< by closing gaps, in the last attempt that was cut for it
    std::vector<Attempt> attempts_;
};

} // namespace osculate::time
