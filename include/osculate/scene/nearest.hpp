#pragma once
/// The name that the user probably meant.

#include <string>
#include <string_view>
#include <vector>

namespace osculate::scene {

/// The candidate at most two edits (insertion, deletion, substitution, transposition) from `word`, one edit for words
/// of two or three letters; empty if there is none. The first of equals.
[[nodiscard]] std::string nearest(std::string_view word, const std::vector<std::string>& candidates);

} // namespace osculate::scene
