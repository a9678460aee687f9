#pragma once
/// Reads and compiles a scene file to a plan.

#include "osculate/app/compile.hpp"
#include "osculate/scene/reader.hpp"

#include <string>
#include <vector>

namespace osculate::app {

struct LoadedScene {
    scene::Scene scene;
    Plan plan;
    std::string path{}; ///< of the scene file; empty: the scene is from a text
};

/// Reads and compiles a scene file.
/// @param ranks  processes that share the run; null: one
/// @throws SceneError with file, line and column for every fault that has a place in the file
[[nodiscard]] LoadedScene load(const std::string& path, const std::vector<scene::Override>& overrides, int threads,
                               Timings& timings, const std::shared_ptr<Ranks>& ranks = nullptr);

} // namespace osculate::app
