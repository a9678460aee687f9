#pragma once
/// A scene from its file to the files of its run.

#include "osculate/output/summary.hpp"
#include "osculate/scene/reader.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace osculate::app {

struct RunOptions {
    std::filesystem::path directory; ///< of the files; out/<scene name>/ when empty
    int threads = 1;
    bool quiet = false;
};

/// Runs a scene. Every file can be read at any moment; those of an earlier run in the same folder are replaced.
/// @returns  what summary.json says at the end
/// @throws SceneError before anything is written; RunFailure when a step cannot be solved or a file not be written, with
///         everything accepted before on disk
output::Summary run(const std::string& scene_path, const std::vector<scene::Override>& overrides,
                    const RunOptions& options);

} // namespace osculate::app
