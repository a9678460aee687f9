#pragma once
/// A run on a thread of its own that waits after every accepted step until it is told to go on.

#include "osculate/app/load.hpp"
#include "osculate/app/run.hpp"
#include "osculate/output/csv_table.hpp"
#include "osculate/output/snapshot.hpp"
#include "osculate/time/stepper.hpp"

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <exception>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

namespace osculate::python {

/// Knows nothing of Python. All members are for one thread, but for those of the observer, which are for the run's.
class Session final : private time::StepObserver {
public:
    enum class Phase {
        created, ///< nothing computed yet
        running, ///< the other thread computes
        step,    ///< waits in an accepted step
        attempt, ///< waits after an attempt that was rejected, as pause() asked for
        ended    ///< completed, stopped, or failed: see failure()
    };
    struct Step {
        int number = 0; ///< 1, 2, ...
        double time = 0, dt = 0;
        int iterations = 0;
        std::string stage;
    };

    /// @throws SceneError, with all faults
    Session(const std::string& path, const std::vector<scene::Override>& overrides, int threads);
    /// Of a scene that is read already, from a text.
    Session(scene::Scene scene, int threads);
    ~Session() override;
    Session(const Session&) = delete;
    Session& operator=(const Session&) = delete;

    /// Has the files of `osculate run` written. To be called before the first go_on().
    void write(app::RunOptions options);
    /// Starts the run, or lets it go on to the next step. Nothing happens where it has ended.
    void go_on();
    /// Waits until it computes no more, at most so long. @returns  whether it does not
    [[nodiscard]] bool wait(std::chrono::milliseconds longest);
    /// The run is to wait after the present attempt, rejected or not.
    void pause();
    /// Ends the run where it waits, or after the present attempt.
    void close();

    [[nodiscard]] Phase phase() const { return phase_; }
    /// The last accepted step.
    [[nodiscard]] const Step& step() const { return step_; }
    /// Whether it waits in a step that was not handed out yet.
    [[nodiscard]] bool has_news() const { return phase() == Phase::step && step_.number != seen_; }
    [[nodiscard]] const Step& hand_out() {
        seen_ = step_.number;
        return step_;
    }
    [[nodiscard]] int rejected() const { return rejected_; }
    [[nodiscard]] bool completed() const { return completed_; }
    /// What ended the run, handed out once; null: nothing did.
    [[nodiscard]] std::exception_ptr take_failure() { return std::exchange(failure_, nullptr); }

    [[nodiscard]] const app::LoadedScene& loaded() const { return loaded_; }
    [[nodiscard]] const model::Model& model() const { return loaded_.plan.model; }
    [[nodiscard]] const model::State& state() const { return stepper_.state(); }
    [[nodiscard]] int threads() const { return threads_; }
    /// The last accepted step as fields look at it; null while the run computes, before its first step, and after it gave up
    /// or was stopped within a step.
    /// @param reactions  whether it has to have them
    [[nodiscard]] const output::Snapshot* snapshot(bool reactions);
    [[nodiscard]] const std::vector<std::string>& history_columns() const { return columns_; }
    [[nodiscard]] const std::vector<std::vector<output::Cell>>& history() const { return history_; }

private:
    explicit Session(app::LoadedScene loaded, int threads);
    void attempted(const time::Attempt& attempt, const std::vector<equilibrium::IterationRecord>& iterations) override;
    void accepted(const time::AcceptedStep& step) override;
    void gave_up(const time::PostMortem& found, const time::FailedIterate* iterate) override;
    void work();
    void wait_at(Phase phase);
    /// Copies what the step it waits in is looked at with: nothing of it is left behind the step.
    void keep_last();

    int threads_;
    Timings timings_;
    app::LoadedScene loaded_;
    time::Stepper stepper_;
    std::optional<app::RunOptions> files_;

    bool reactions_;          ///< whether the history has any
    std::vector<Index> sets_; ///< of the history
    bool ledger_;
    std::vector<std::string> columns_;
    std::vector<std::vector<output::Cell>> history_;

    Step step_;
    int seen_ = 0; ///< number of the last one handed out
    int rejected_ = 0;
    bool completed_ = false;
    const equilibrium::Equilibrium* equilibrium_ = nullptr; ///< while it waits in a step
    bool has_reactions_ = false;
    model::ContactEvaluations last_;           ///< see keep_last()
    std::optional<output::Snapshot> snapshot_; ///< of the last accepted step; none while the run computes
    std::exception_ptr failure_;
    std::string post_mortem_;

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    std::atomic<Phase> phase_ = Phase::created;
    bool pausing_ = false, closing_ = false;
    std::thread thread_;
};

} // namespace osculate::python
