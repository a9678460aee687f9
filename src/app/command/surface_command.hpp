#pragma once
/// Master surfaces of a scene as the solver sees them, before any run.

#include "osculate/app/run.hpp"
#include "osculate/scene/reader.hpp"

#include <filesystem>
#include <string>
#include <vector>

namespace osculate::app {

struct SurfaceOptions {
    std::string pair;                ///< the only pair to write; all of them when empty
    std::filesystem::path directory; ///< of the files; out/<scene name>/surface/ when empty
    int refine = 8;                  ///< every facet is cut into refine x refine cells
    int threads = 1;
    FolderOptions folder{};
};

/// Writes <pair>.vtp, the master surface of every pair as a fine tessellation, and <pair>_edges.vtp, its boundary and
/// feature edges. Where the surface is not found the tessellation keeps the facet; the array `found` is 0 there.
/// Every facet has its own points, on its edges too: what is not smooth across an edge shows. Mirror images beyond
/// symmetry planes shape the surface but are not written.
/// @returns  a summary in words
/// @throws SceneError before anything is written, RunFailure when a file cannot be written
[[nodiscard]] std::string write_surfaces(const std::string& scene_path, const std::vector<scene::Override>& overrides,
                                         const SurfaceOptions& options);

} // namespace osculate::app
