#pragma once
/// `osculate mesh` of a file of geometry.

#include "app/command/mesh_command.hpp"

#include <string>

namespace osculate::app {

/// Its solids, faces and edges, with the names that sets of a scene use; writes the picture that is asked for.
/// @throws mesh::MeshError, SceneError
[[nodiscard]] std::string describe_geometry(const MeshCommand& command);

} // namespace osculate::app
