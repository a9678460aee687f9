#pragma once
/// Nouns in sentences.

#include <string>

namespace osculate::scene {

/// "an angle", "a length".
inline std::string with_article(const std::string& noun) {
    const bool vowel = std::string("aeiou").find(noun.front()) != std::string::npos;
    return (vowel ? "an " : "a ") + noun;
}

} // namespace osculate::scene
