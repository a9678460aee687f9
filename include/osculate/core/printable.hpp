#pragma once
/// Control characters of texts that people or other programs read.

#include <cstddef>
#include <string>
#include <string_view>

namespace osculate {

/// Of ASCII: below a space, and DEL. Such a character can end the line or the string that a text is written into.
[[nodiscard]] constexpr bool is_control(char c) {
    constexpr unsigned char del = 0x7f;
    return static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) == del;
}

/// Place of the first control character that is not among `allowed`; std::string_view::npos without one.
[[nodiscard]] std::size_t find_control(std::string_view text, std::string_view allowed = {});

/// What a control character is called: "a line break", "a tab", "the character \x1b".
[[nodiscard]] std::string control_name(char c);

/// A text on one line for a terminal or a comment: control characters as \n, \t, \r or \x1b.
[[nodiscard]] std::string printable(std::string_view text);

} // namespace osculate
