#pragma once
/// The name that was meant.

#include <string>
#include <string_view>
#include <vector>

namespace osculate::scene {

/// The candidate at most two edits (insertion, deletion, substitution, transposition) from `word`, one for words of two
/// or three letters; empty when there is none. The first of equals.
[[nodiscard]] std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

} // namespace osculate::scene
