#pragma once
/// A scene from its file to the files of its run.

#include "osculate/core/error.hpp"
#include "osculate/output/summary.hpp"
#include "osculate/scene/reader.hpp"

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace osculate::app {

struct RunOptions {
    std::filesystem::path directory; ///< of the files; out/<scene name>/ when empty
    int threads = 1;
    bool quiet = false;
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

/// Runs a scene. Every file can be read at any moment; those of an earlier run in the same folder are replaced.
/// @returns  what summary.json says at the end
/// @throws SceneError before anything is written; GaveUp when a step cannot be solved, RunFailure when a file cannot be
///         written, with everything accepted before on disk
output::Summary run(const std::string& scene_path, const std::vector<scene::Override>& overrides,
                    const RunOptions& options);

} // namespace osculate::app
