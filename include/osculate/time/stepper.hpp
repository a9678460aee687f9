#pragma once
/// Runs the stages of a run step by step. A step is a transaction: it is accepted as a whole or leaves no trace.

#include "osculate/equilibrium/equilibrium.hpp"
#include "osculate/time/attempt.hpp"
#include "osculate/time/audit.hpp"
#include "osculate/time/checkpoint.hpp"
#include "osculate/time/ledger.hpp"
#include "osculate/time/progress.hpp"
#include "osculate/time/solve_ladder.hpp"
#include "osculate/time/stage.hpp"

#include <functional>
#include <memory>

namespace osculate::time {

class BesideRun;
struct RunContext;
struct FailedAttempt;
struct PostMortem;

struct StepperOptions {
    double tolerance = 1e-9;
    int max_iterations = 30;
    int reject_every = 0; ///< rejects every k-th attempt on purpose, to test that it leaves no trace; 0: none
    bool predictor = true;
    bool stabilisation = true; ///< see StabilisationOptions
    int threads = 1;
    bool audit = false; ///< audit every solved step, see Audit
};

/// An accepted step, valid only during StepObserver::accepted.
struct AcceptedStep {
    const model::State& state;
    const equilibrium::Equilibrium& equilibrium; ///< evaluated at `state`
    double dt = 0;
    int iterations = 0;
    const Stage& stage;
    const Ledger* ledger = nullptr;              ///< null in statics
    const contact::AuditResult* audit = nullptr; ///< null: no audit
};

/// The last iterate of the attempt at which a run failed, valid only during StepObserver::gave_up.
struct FailedIterate {
    const FailedAttempt& attempt;
    const model::State& state;                   ///< its time is the planned end of the attempt
    const equilibrium::Equilibrium& equilibrium; ///< evaluated at `state` if that is finite
};

class StepObserver {
public:
    virtual ~StepObserver() = default;
    virtual void attempted(const Attempt& attempt, const std::vector<equilibrium::IterationRecord>& iterations) = 0;
    virtual void accepted(const AcceptedStep& step) = 0;
    /// After every accepted step, when all its data is complete: an exception here ends the run.
    /// @param checkpoint  returns a checkpoint; must not be called later
    virtual void between_steps(const std::function<Checkpoint()>& checkpoint) { (void)checkpoint; }
    /// Before the run ends with a RunFailure. @param iterate  null if there was none: a load without a value
    virtual void gave_up(const PostMortem& post_mortem, const FailedIterate* iterate) {
        (void)post_mortem, (void)iterate;
    }
};

class Stepper {
public:
    Stepper(const model::Model& model, std::vector<Stage> stages, StepperOptions options, Timings& timings);
    ~Stepper();

    /// Runs every stage. Throws RunFailure with the cause in words if a step cannot be solved at its smallest size; the
    /// observer has then seen all accepted steps.
    void run(StepObserver& observer);
    /// Makes run() continue from a checkpoint of the same model, stages and options. Call it before run().
    /// @throws RunFailure if the checkpoint does not fit
    void resume(Checkpoint checkpoint);
    /// Makes run() take these runs along; they must outlive it. Observers see an accepted step after they have
    /// followed it. Leaves no trace in the run itself.
    void lead(std::vector<BesideRun*> beside);

    [[nodiscard]] const model::State& state() const {
        return progress_.state;
    } ///< accepted last; its arrays stay in place
    [[nodiscard]] const RunCounts& counts() const { return progress_.counts; }
    [[nodiscard]] double end_time() const;

private:
    std::vector<Stage> stages_;
    std::unique_ptr<RunContext> context_;
    Progress progress_;
    std::unique_ptr<const Checkpoint> resumed_; ///< until run() has continued from it
};

} // namespace osculate::time
