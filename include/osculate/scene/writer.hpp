#pragma once
/// Writes a Scene as YAML.

#include "osculate/scene/scene.hpp"

#include <string>

namespace osculate::scene {

/// The resolved scene: every default filled in, SI numbers. Reading it back gives an equal Scene.
[[nodiscard]] std::string write_scene(const Scene& scene);

} // namespace osculate::scene
