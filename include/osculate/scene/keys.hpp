#pragma once
/// Description of the keys of a scene file.

#include <string>

namespace osculate::scene {

/// Describes every key at or below a path: path, type and unit, range, default, meaning.
/// @param path_prefix  dotted path such as "contact.sliding.master"; empty for all. Names of the scene's own bodies,
///                     sets, pairs and stages are accepted for <body>, <set>, <pair>, <stage> of the list
/// @returns empty if there is no such key
[[nodiscard]] std::string describe_keys(const std::string& path_prefix);

} // namespace osculate::scene
