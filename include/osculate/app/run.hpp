#pragma once
/// Runs a scene file and writes the files of the run.

#include "osculate/app/load.hpp"
#include "osculate/core/error.hpp"
#include "osculate/core/ranks.hpp"
#include "osculate/output/output_folder.hpp"
#include "osculate/output/summary.hpp"
#include "osculate/scene/reader.hpp"

#include <filesystem>
#include <functional>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace osculate::app {

/// Paths in a run's folder.
inline constexpr const char* checkpoint_path = "checkpoint/state";
inline constexpr const char* previous_checkpoint_path = "checkpoint/state.previous";

/// Interval of checkpoints: after this number of accepted steps, or of seconds, whichever is set; 0: never.
struct CheckpointEvery {
    long steps = 0;
    double seconds = 0;
};
/// Parses "20" (steps) or "5 min" (a time).
/// @throws SceneError
[[nodiscard]] CheckpointEvery parse_checkpoint_every(const std::string& text);

/// Permitted content of an output folder, see output::OutputFolder.
struct FolderOptions {
    bool force = false;    ///< anything; overwrites files
    bool numbered = false; ///< nothing: if it is not empty, a number is added to the folder's name
};

[[nodiscard]] output::OutputFolder::Entry entry_of(const FolderOptions& options);
/// The requested folder, or another one if FolderOptions::numbered requires it. @throws RunFailure
[[nodiscard]] std::filesystem::path chosen_folder(const std::filesystem::path& directory, const FolderOptions& options);

struct RunOptions {
    std::filesystem::path
        directory; ///< output folder; out/<scene name>/ if empty. In resume(): of a process that is not the first
    int threads = 1;
    bool quiet = false;
    CheckpointEvery checkpoint_every{};
    bool heed_signals =
        true; ///< SIGINT and SIGTERM end the run between two steps; false: the caller has to handle these signals
    FolderOptions folder{};
    std::shared_ptr<Ranks> ranks{}; ///< processes that share the run, each of which makes this call; null: one
    std::function<void(const std::filesystem::path&)>
        entered{}; ///< called with the folder before the first step; may be empty
};

/// A signal ended the run between two steps, after a checkpoint was written.
class Interrupted : public std::runtime_error {
public:
    Interrupted(int signal, double time, std::filesystem::path directory);
    /// The same of a run that cannot go on later: without a checkpoint.
    Interrupted(int signal, double time);
    [[nodiscard]] int signal() const noexcept { return signal_; }

private:
    int signal_;
};

/// An observer throws this from between_steps(), accepted() or attempted() to end a run that writes files; its summary
/// then says `interrupted`.
class Stopped : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A run failed, and its last attempt was examined.
class GaveUp : public RunFailure {
public:
    /// @param post_mortem  in words, lines
    GaveUp(const std::string& message, std::string post_mortem)
        : RunFailure(message), post_mortem_(std::move(post_mortem)) {}
    [[nodiscard]] const std::string& post_mortem() const noexcept { return post_mortem_; }

private:
    std::string post_mortem_;
};

/// Runs a scene. On SIGINT or SIGTERM it finishes the step and writes a checkpoint. Every file can be read at any
/// moment. First removes the files of an earlier run in the same folder, and nothing else.
/// @returns content of summary.json at the end
/// @throws SceneError before anything is written, also for an unsuitable folder; Interrupted; GaveUp if a step cannot
///         be solved, RunFailure if a file cannot be written, with all accepted steps on disk
output::Summary run(const std::string& scene_path, const std::vector<scene::Override>& overrides,
                    const RunOptions& options);

/// Runs a compiled scene, and writes the same files.
/// @param stepper  of loaded.plan, not run yet; like `loaded` and `timings` it remains the caller's and can be
///                 inspected later
/// @param beside   called after the files are written, for the same events; null: none
/// @throws like run() above, and whatever `beside` throws
output::Summary run(const LoadedScene& loaded, time::Stepper& stepper, Timings& timings, const RunOptions& options,
                    time::StepObserver* beside = nullptr);

/// Continues a run from the checkpoint in its folder, with bitwise the same results as without interruption. Files that
/// the run had written after the checkpoint are written again.
/// @param directory  of the run's files
/// @param from       a checkpoint; empty: checkpoint/state in that folder
/// @returns as run(); no value, and nothing done, if the run is complete and `from` is empty
/// @throws like run(); SceneError if the folder, its scene or the checkpoint is unsuitable
std::optional<output::Summary> resume(const std::filesystem::path& directory, const std::filesystem::path& from,
                                      const RunOptions& options);

} // namespace osculate::app
