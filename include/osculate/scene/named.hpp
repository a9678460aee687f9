#pragma once
/// Maps that keep the order of a scene file.

#include <string>
#include <utility>
#include <vector>

namespace osculate::scene {

/// Insertion-ordered name -> value map: the order of a scene file is kept.
template <class T> using Named = std::vector<std::pair<std::string, T>>;

} // namespace osculate::scene
