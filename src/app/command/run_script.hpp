#pragma once
/// `osculate run --emit slurm`: a run as a job of a cluster.

#include "osculate/scene/reader.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace osculate::app {

struct RunScript {
    std::string scene;
    std::vector<std::string> changes; ///< key=value
    std::filesystem::path folder;     ///< of the run's files; empty: out/<scene name>
    std::string checkpoint_every;     ///< empty: see default_interval
    int processes = 1, threads = 1;
};

/// Writes DIR.sbatch beside the folder of a run, after it has read and compiled the scene. Before the job's time is over the run
/// writes a checkpoint, and the job queues again to go on from it.
/// @returns  what to do with it
/// @throws SceneError for a bad scene, and where processes cannot share it; RunFailure where the file cannot be written
[[nodiscard]] std::string write_run_script(const RunScript& script, const std::vector<scene::Override>& overrides);

} // namespace osculate::app
