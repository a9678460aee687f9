#pragma once

#include "osculate/scene/reader.hpp"
#include "scene/tree.hpp"

namespace osculate::scene {

/// Parts of a dotted key path, the short form contact.PAIR.surface written out.
[[nodiscard]] std::vector<std::string> split_path(const std::string& path);

/// Writes out what short forms stand for: `master: NAME` and `surface` of a contact pair, a file's name, `repair: true`.
void expand_short_forms(Tree& scene, std::vector<Fault>& faults);

/// Replaces or adds the value at the override's key path, making the maps on the way.
void apply(const Override& change, Tree& scene, std::vector<Fault>& faults);

} // namespace osculate::scene
