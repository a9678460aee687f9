#pragma once
/// Keywords of decks that scenes have nothing for.

#include <string>

namespace osculate::deck {

/// Why a keyword has no counterpart.
struct NoCounterpart {
    const char* why;
    bool lost; ///< bodies would move otherwise with it
};

/// @param word  without blanks
[[nodiscard]] NoCounterpart no_counterpart(const std::string& word);

} // namespace osculate::deck
