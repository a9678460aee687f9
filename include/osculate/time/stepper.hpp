#pragma once
/// Takes the stages of a run step by step. A step is a transaction: it is accepted whole or leaves no trace.

#include "osculate/time/attempt.hpp"
#include "osculate/time/audit.hpp"
#include "osculate/time/checkpoint.hpp"
#include "osculate/time/equilibrium.hpp"
#include "osculate/time/ledger.hpp"
#include "osculate/time/solve_ladder.hpp"
#include "osculate/time/stage.hpp"

#include <functional>
#include <memory>

namespace osculate::time {

struct FailedAttempt;
struct PostMortem;

struct StepperOptions {
    double tolerance = 1e-9;
    int max_iterations = 30;
    int reject_every = 0; ///< rejects every k-th attempt on purpose, to see that it leaves no trace; 0 none
    bool predictor = true;
    bool stabilisation = true; ///< see StabilisationOptions
    int threads = 1;
    LinearSolver linear_solver = LinearSolver::automatic;
    bool audit = false; ///< of every solved step, see Audit
};

/// An accepted step, valid during StepObserver::accepted only.
struct AcceptedStep {
    const model::State& state;
    const Equilibrium& equilibrium; ///< evaluated at `state`
    double dt = 0;
    int iterations = 0;
    const Stage& stage;
    const Ledger* ledger = nullptr;              ///< null in statics
    const contact::AuditResult* audit = nullptr; ///< null: there was none
};

/// The last iterate of the attempt at which a run gave up, valid during StepObserver::gave_up only.
struct FailedIterate {
    const model::State& state;      ///< time: what the attempt aimed at
    const Equilibrium& equilibrium; ///< evaluated at `state` where that is finite
};

class StepObserver {
public:
    virtual ~StepObserver() = default;
    virtual void attempted(const Attempt& attempt, const std::vector<IterationRecord>& iterations) = 0;
    virtual void accepted(const AcceptedStep& step) = 0;
    /// After every accepted step, when all that belongs to it is done: what it throws ends the run there.
    /// @param checkpoint  takes one; not to be called later
    virtual void between_steps(const std::function<Checkpoint()>& checkpoint) { (void)checkpoint; }
    /// Before the run ends with a RunFailure. @param iterate  null where there was none: a load without a value
    virtual void gave_up(const PostMortem& post_mortem, const FailedIterate* iterate) {
        (void)post_mortem, (void)iterate;
    }
};

class Stepper {
public:
    Stepper(const model::Model& model, std::vector<Stage> stages, StepperOptions options, Timings& timings);

    /// Runs every stage. Throws RunFailure with the cause in words when a step cannot be solved at its smallest size;
    /// everything accepted before has been observed.
    void run(StepObserver& observer);
    /// run() is to go on from there. To be called before it, with a checkpoint of the same model, stages and options.
    /// @throws RunFailure where it cannot be one
    void resume(Checkpoint checkpoint);

    [[nodiscard]] const model::State& state() const { return state_; } ///< accepted last; its arrays stay in place
    [[nodiscard]] long factorisations() const { return factorisations_; }
    [[nodiscard]] long gmres_iterations() const { return gmres_iterations_; }
    /// Master patches fitted anew between steps, see contact::MasterSurface::refitted().
    [[nodiscard]] long refreshed_patches() const { return refreshed_patches_; }
    /// Paths of slave nodes that were followed facet by facet, see CollisionCheck.
    [[nodiscard]] long paths_followed() const { return paths_followed_; }
    /// Steps accepted on the rung `stabilised`, see climb().
    [[nodiscard]] int stabilised_steps() const { return stabilised_steps_; }
    /// Steps accepted with a residual above the tolerance but at the round-off of its rows, see Equilibrium::rests().
    [[nodiscard]] int steps_at_round_off() const { return steps_at_round_off_; }
    [[nodiscard]] double end_time() const;

private:
    /// @param from  where to go on in it; null: at its start
    void run_stage(const Stage& stage, StepObserver& observer, const Checkpoint* from);
    /// Largest of Integrator::local_error() over the nodes with mass, free directions, m. @param worst  whose it is
    [[nodiscard]] double local_error(const Dynamics& dynamics, const model::Constraints& constraints,
                                     const std::vector<Vec3>& a, double dt, Index& worst) const;
    /// Fits strongly bent patches of the accepted state's masters anew.
    void refresh_patches();
    [[nodiscard]] StepLoad load_at(const Stage& stage, const model::Constraints& constraints,
                                   const std::vector<Vec3>& prescribed_start, double elapsed) const;
    /// Moves every driven body rigidly by the increment of its held components, where one rigid motion fits them all.
    void predict(const model::Constraints& constraints, const std::vector<Vec3>& prescribed,
                 std::vector<Vec3>& u) const;
    /// Statuses to start from; true where a pair is brought into contact by hand because nothing of it is closed yet.
    [[nodiscard]] bool starting_statuses(Equilibrium& equilibrium, const Vector& z, Statuses& statuses) const;
    /// What forces are measured by, N; 0 where nothing acts yet.
    [[nodiscard]] double reference_force(const Stage& stage, const StepLoad& load, const Equilibrium& equilibrium,
                                         double dt) const;
    /// Reference force over displacement that round-off calls for, N/m: internal forces of a rigid motion are round-off of
    /// stiffness times displacement.
    [[nodiscard]] double round_off_force() const;
    [[nodiscard]] double largest_displacement() const; ///< component of the accepted state, m
    /// Norm of the residual at z, contact laws included: the reference where it is initial overlap alone that acts, N.
    [[nodiscard]] static double imbalance(Equilibrium& equilibrium, const Vector& z, const Statuses& statuses,
                                          bool forced);
    /// M a = f - K u - C v + contact forces of the state, a = 0 along held directions.
    void find_initial_acceleration(const Stage& stage, const model::Constraints& constraints,
                                   const std::vector<Vec3>& force);
    /// Velocities, accelerations and ledger at the start of the first dynamic stage after statics, or at all.
    void start_motion(const Stage& stage, const model::Constraints& constraints, StepLoad load);
    /// Of the last rung of an attempt from displacements u, contact evaluated there.
    [[nodiscard]] StabilisationOptions stabilisation_options(const model::ContactEvaluations& contact) const;
    /// The attempt's row of the diary.
    Attempt diary(const Decision& decision, const LadderResult& result, const Equilibrium& equilibrium, double time,
                  double dt, int iterations);
    /// Examines the attempt, tells the observer and throws RunFailure.
    [[noreturn]] void give_up(const FailedAttempt& failed, Equilibrium& equilibrium, StepObserver& observer) const;

    const model::Model& model_;
    std::vector<Stage> stages_;
    StepperOptions options_;
    Timings& timings_;
    model::State state_;
    Ledger ledger_;
    bool moved_ = false; ///< a dynamic stage has begun
    int attempts_ = 0;
    int stabilised_steps_ = 0, steps_at_round_off_ = 0;
    std::unique_ptr<Audit> audit_;        ///< null: not wanted
    std::unique_ptr<Checkpoint> resumed_; ///< until run() has gone on from it
    long factorisations_ = 0, gmres_iterations_ = 0, refreshed_patches_ = 0, paths_followed_ = 0;
    double characteristic_length_ = 1;
    double largest_stiffness_ = 0;              ///< model::largest_stiffness
    mutable std::vector<double> volume_shares_; ///< model::volume_shares, once a ladder has asked for them
};

} // namespace osculate::time
