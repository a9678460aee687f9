#pragma once
/// `osculate mesh`: what a mesh file holds.

#include "osculate/core/error.hpp"
#include "osculate/mesh/mesh_error.hpp"

#include <string>
#include <vector>

namespace osculate::app {

struct MeshCommand {
    std::string file, part;
    int piece = 0;
    std::vector<std::string> repair; ///< words of scenes
    std::string picture;             ///< SVG of a geometry; empty: none
};

/// Of geometry solids, faces and edges; of a mesh:
/// Sizes, parts, surfaces and node sets of a file's mesh, or of a part of it, and what was mended.
/// Throws SceneError with all of its faults.
[[nodiscard]] std::string describe_mesh(const MeshCommand& command);

/// The reasons as faults of a scene.
[[nodiscard]] SceneError mesh_faults(const mesh::MeshError& error, const std::string& key);

} // namespace osculate::app
