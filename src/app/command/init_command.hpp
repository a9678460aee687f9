#pragma once
/// The command `osculate init`.

#include <string>

namespace osculate::app {

/// Names of the tutorials, each with what its scene shows.
[[nodiscard]] std::string tutorial_list();

/// Copies a tutorial and the meshes it reads; nothing is overwritten.
/// @param file  the new scene; <name>.yaml when empty
/// @returns what there is to say
/// @throws SceneError for a name that is no tutorial's, or a file that is there or cannot be written
[[nodiscard]] std::string init_scene(const std::string& name, const std::string& file);

} // namespace osculate::app
