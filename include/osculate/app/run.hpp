#pragma once
/// A scene from its file to the files of its run.

#include "osculate/app/load.hpp"
#include "osculate/core/error.hpp"
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

/// In a run's folder.
inline constexpr const char* checkpoint_path = "checkpoint/state";
inline constexpr const char* previous_checkpoint_path = "checkpoint/state.previous";

/// How often a run writes a checkpoint: after so many accepted steps, or so many seconds, whichever is set; 0 never.
struct CheckpointEvery {
    long steps = 0;
    double seconds = 0;
};
/// From "20", steps, or "5 min", a time.
/// @throws SceneError
[[nodiscard]] CheckpointEvery parse_checkpoint_every(const std::string& text);

/// What there may be in a folder that files are to be written into, see output::OutputFolder.
struct FolderOptions {
    bool force = false;    ///< anything; files are overwritten
    bool numbered = false; ///< nothing: where something is, the folder's name gets a number
};

[[nodiscard]] output::OutputFolder::Entry entry_of(const FolderOptions& options);
/// The folder that is asked for, of which FolderOptions::numbered may make another. @throws RunFailure
[[nodiscard]] std::filesystem::path chosen_folder(const std::filesystem::path& directory, const FolderOptions& options);

struct RunOptions {
    std::filesystem::path directory; ///< of the files; out/<scene name>/ when empty
    int threads = 1;
    bool quiet = false;
    CheckpointEvery checkpoint_every{};
    bool heed_signals =
        true; ///< SIGINT and SIGTERM end the run between two steps; false: they are the caller's business
    FolderOptions folder{};
    std::function<void(const std::filesystem::path&)>
        entered{}; ///< told the folder before the first step; null: nobody
};

/// A run that was asked to end by a signal, and did between two steps, with a checkpoint written.
class Interrupted : public std::runtime_error {
public:
    Interrupted(int signal, double time, std::filesystem::path directory);
    [[nodiscard]] int signal() const noexcept { return signal_; }

private:
    int signal_;
};

/// What an observer throws from between_steps(), accepted() or attempted() to end a run that writes files: its summary then
/// says `interrupted`.
class Stopped : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

/// A run that gave up after an examination of its last attempt.
class GaveUp : public RunFailure {
public:
    /// @param post_mortem  in words, lines
    GaveUp(const std::string& message, std::string post_mortem)
        : RunFailure(message), post_mortem_(std::move(post_mortem)) {}
    [[nodiscard]] const std::string& post_mortem() const noexcept { return post_mortem_; }

private:
    std::string post_mortem_;
};

/// Runs a scene. On SIGINT or SIGTERM it finishes the step and writes a checkpoint. Every file can be read at any moment; those of an earlier run in the same folder are
/// removed first, and nothing else.
/// @returns  what summary.json says at the end
/// @throws SceneError before anything is written, also where the folder is not one to write into; Interrupted; GaveUp when a step cannot be solved, RunFailure when a file cannot be
///         written, with everything accepted before on disk
output::Summary run(const std::string& scene_path, const std::vector<scene::Override>& overrides,
                    const RunOptions& options);

/// Runs a scene that is compiled, writing the same files.
/// @param stepper  of loaded.plan, not run yet. Like `loaded` and `timings` it is the caller's, who can look at it later
/// @param beside   told what the files are told, after them; null: nobody
/// @throws as run() above does, and what `beside` throws
output::Summary run(const LoadedScene& loaded, time::Stepper& stepper, Timings& timings, const RunOptions& options,
                    time::StepObserver* beside = nullptr);

/// Goes on with a run from the checkpoint in its folder, to the same bits as without a break. What the run had written after the
/// checkpoint is written anew.
/// @returns          as run() does; nothing where the run is complete, and nothing is done unless `from` says otherwise
/// @param directory  of the run's files
/// @param from       a checkpoint; empty: checkpoint/state in that folder
/// @throws as run() does; SceneError where the folder, its scene or the checkpoint are not what they have to be
std::optional<output::Summary> resume(const std::filesystem::path& directory, const std::filesystem::path& from,
                                      const RunOptions& options);

} // namespace osculate::app
