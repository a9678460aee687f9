#pragma once
/// From a YAML scene file to a validated Scene.

#include "osculate/core/error.hpp"
#include "osculate/scene/scene.hpp"

#include <string>
#include <vector>

namespace osculate::scene {

/// A value given on the command line, `--set key.path=value`.
struct Override {
    std::string key;   ///< dotted key path
    std::string value; ///< read as YAML: a scalar, a list or a map
};

/// Reads and validates a scene file.
/// @param overrides  replace or add values before validation, in the given order; the short form contact.PAIR.surface
///                   stands for contact.PAIR.master.surface
/// @throws SceneError with all faults, sorted by place; a fault of an override has "--set" as file
[[nodiscard]] Scene read_scene(const std::string& path, const std::vector<Override>& overrides = {});

/// The same for a text; faults use `name` as file, relative paths start at the current folder.
[[nodiscard]] Scene parse_scene(const std::string& yaml_text, const std::string& name,
                                const std::vector<Override>& overrides = {});

} // namespace osculate::scene
