#pragma once
/// Texts of a scene that is written from a deck.

#include "deck/model.hpp"

#include <set>
#include <string>

namespace osculate::deck {

/// Letters, digits, _ and -, as scenes want names.
[[nodiscard]] std::string scene_name(const std::string& name);

/// A name that is not taken yet, which it is from then on.
[[nodiscard]] std::string fresh_name(const std::string& wanted, std::set<std::string>& taken);

/// In double quotes, as YAML has it.
[[nodiscard]] std::string in_quotes(const std::string& text);

/// To 12 digits.
[[nodiscard]] std::string number(double value);

/// A value of a stage: itself, or a table of it times its amplitude. @param factors  null: none
[[nodiscard]] std::string course(double value, const Amplitude* factors);

/// Text of a deck for a comment.
[[nodiscard]] std::string harmless(const std::string& text);

} // namespace osculate::deck
