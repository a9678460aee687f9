#pragma once
/// Derivatives of what a run writes by numbers of its scene.

#include "osculate/app/load.hpp"
#include "osculate/output/csv_table.hpp"
#include "osculate/output/output_folder.hpp"
#include "osculate/time/perturbed_run.hpp"

#include <memory>
#include <string>
#include <vector>

namespace osculate::app {

class Gradients;

/// derivatives/NAME/history.csv and derivatives/NAME/probes/PROBE.csv: the same columns as the run's own, but of derivatives, by
/// the SI unit of the number. Two runs of the scene with the number a little larger and smaller follow the run, see
/// time::PerturbedPair.
class Derivatives {
public:
    /// @param timings  of the run
    /// @throws SceneError where a changed scene is none, or has another mesh, other pairs or other equations
    Derivatives(const LoadedScene& loaded, int threads, Timings& timings);
    ~Derivatives();
    Derivatives(const Derivatives&) = delete;
    Derivatives& operator=(const Derivatives&) = delete;

    /// Files that a run may write, relative to its folder.
    [[nodiscard]] static std::vector<std::string> files(const scene::Scene& scene, const Plan& plan);

    /// For time::Stepper::lead().
    [[nodiscard]] std::vector<time::BesideRun*> runs() const;
    /// Opens the tables in the folder of the run. @throws std::runtime_error like accepted()
    void open(output::OutputFolder& folder);
    /// Rows of an accepted step.
    /// @param probes  numbers of the plan's probes that have a row
    void accepted(const time::AcceptedStep& step, const std::vector<std::size_t>& probes);
    /// Writes what is known at the end of the run alone. @throws std::runtime_error
    void finish(const std::filesystem::path& folder);
    /// What makes derivatives unreliable.
    [[nodiscard]] std::vector<std::string> warnings() const;

private:
    struct One;
    const LoadedScene& loaded_;
    std::vector<std::unique_ptr<One>> all_;
    std::unique_ptr<Gradients> gradients_; ///< null: none is asked for
};

} // namespace osculate::app
