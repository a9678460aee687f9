#pragma once
/// The keys of a scene file, in words.

#include <string>

namespace osculate::scene {

/// Every key at or below a path: path, type and unit, range, default, meaning.
/// @param path_prefix  dotted path such as "contact.sliding.master"; empty for all. Names of the scene's own bodies, sets,
///                     pairs and stages are accepted where the list says <body>, <set>, <pair>, <stage>
/// @returns  empty when there is no such key
[[nodiscard]] std::string describe_keys(const std::string& path_prefix);

} // namespace osculate::scene
