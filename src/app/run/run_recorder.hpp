#pragma once
/// Writes the files of a run while it goes.

#include "app/run/derivatives.hpp"
#include "app/run/interruption.hpp"
#include "osculate/app/compile.hpp"
#include "osculate/app/run.hpp"
#include "osculate/app/run_checks.hpp"
#include "osculate/output/checkpoint_file.hpp"
#include "osculate/output/csv_table.hpp"
#include "osculate/output/frames.hpp"
#include "osculate/output/history.hpp"
#include "osculate/output/output_folder.hpp"
#include "osculate/output/probe_file.hpp"
#include "osculate/output/progress.hpp"
#include "osculate/output/summary.hpp"

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace osculate::app {

/// history.csv, steps.csv, iterations.csv, frames and probes of a run, its summary.json, plots, the post-mortem and the
/// line of progress. What the scene does not name is neither written nor computed. Every member throws RunFailure when a file cannot be written.
class RunRecorder final : public time::StepObserver {
public:
    struct Settings {
        output::OutputFolder* folder = nullptr;
        int threads = 1;
        bool quiet = false;
        std::chrono::steady_clock::time_point begin; ///< of the run, its reading included
        CheckpointEvery checkpoint_every{};
        const output::CheckpointFile* from = nullptr; ///< what the run goes on from; null: it begins
        const Interruption* interruption = nullptr;   ///< null: nothing to heed
        Derivatives* derivatives = nullptr;           ///< whose runs the stepper leads; null: none
        std::filesystem::path frames_folder{}; ///< of a process that is not the first; empty: frames go into the folder
    };

    /// Removes what an earlier run left in the folder, writes the resolved scene and the state before the first step; or
    /// takes files and counts back to those of a checkpoint. Scene, plan, stepper and timings must outlive it.
    RunRecorder(const scene::Scene& scene, const Plan& plan, const time::Stepper& stepper, Timings& timings,
                Settings settings);

    /// Every file that a run of this scene may write, relative to its folder, `*` standing for a number.
    [[nodiscard]] static std::vector<std::string> files(const scene::Scene& scene, const Plan& plan);

    void attempted(const time::Attempt& attempt, const std::vector<equilibrium::IterationRecord>& iterations) override;
    void accepted(const time::AcceptedStep& step) override;

    /// Writes a checkpoint where one is due. @throws Interrupted after one, where a signal asks for that
    void between_steps(const std::function<time::Checkpoint()>& checkpoint) override;

    /// Writes post_mortem.json and, where the scene asks for it, the last iterate into the folder failed/.
    void gave_up(const time::PostMortem& examined, const time::FailedIterate* iterate) override;

    /// Every frame so far is written when it returns.
    void wait_for_frames();
    /// Says how the run ended, and on stderr whether that was expected.
    void finish(const std::string& status, const std::string& failure = {});
    [[nodiscard]] const output::Summary& summary() const { return summary_; }
    /// The post-mortem in words; empty where there is none.
    [[nodiscard]] const std::string& post_mortem() const { return post_mortem_; }

private:
    [[nodiscard]] const std::filesystem::path& directory() const { return settings_.folder->path(); }
    [[nodiscard]] std::vector<std::string> tables() const;
    void remove_what_is_written_anew();
    [[nodiscard]] bool resumed() const { return settings_.from != nullptr; }
    /// Bytes to keep of a table in the run's folder; not given: it starts anew.
    [[nodiscard]] std::optional<std::uintmax_t> kept(const std::string& table) const;
    void recall(const output::CheckpointFile& from);
    void write_checkpoint(const time::Checkpoint& checkpoint);
    void describe_plan();
    struct Spent {
        double total = 0, cpu = 0; ///< s
        long peak_bytes = 0;       ///< of this process
    };
    [[nodiscard]] Spent spent_so_far() const;
    void write_initial_frame();
    void write_failed(const time::FailedIterate& iterate);
    /// Numbers of the plan's probes that have a row at the current step.
    [[nodiscard]] std::vector<std::size_t> probes_due(bool last) const;
    void write_summary();
    void count_up(); ///< what the summary says by now
    /// Plots, then the report, of the run's files once they are complete; they say what could not be made, and go on.
    void draw_plots();
    void report();

    const scene::Scene& scene_;
    const Plan& plan_;
    const time::Stepper& stepper_;
    Timings& timings_;
    Settings settings_;
    output::Summary summary_;
    std::string post_mortem_;
    std::unique_ptr<output::CsvTable> steps_, iterations_;
    std::unique_ptr<output::History> history_;
    std::unique_ptr<output::Frames> frames_;
    std::vector<output::ProbeFile> probes_; ///< as those of the plan
    output::Progress progress_;
    RunChecks checks_;
    std::optional<std::uint64_t> fingerprint_; ///< of the meshes, from the first checkpoint on
    long checkpoint_step_ = 0;                 ///< accepted steps at the last checkpoint
    std::chrono::steady_clock::time_point checkpoint_time_;
    double seconds_before_ = 0, cpu_seconds_before_ = 0; ///< of the run before it was resumed
};

} // namespace osculate::app
