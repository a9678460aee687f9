#pragma once
/// Control characters in texts that people or other programs read.

#include <cstddef>
#include <string>
#include <string_view>

namespace osculate {

/// Whether c is an ASCII control character: below a space, or DEL. Such a character can end the line or the string into
/// which a text is written.
[[nodiscard]] constexpr bool is_control(char c) {
    constexpr unsigned char del = 0x7f;
    return static_cast<unsigned char>(c) < ' ' || static_cast<unsigned char>(c) == del;
}

/// Position of the first control character that is not among `allowed`; std::string_view::npos if there is none.
[[nodiscard]] std::size_t find_control(std::string_view text, std::string_view allowed = {});

/// Name of a control character: "a line break", "a tab", "the character \x1b".
[[nodiscard]] std::string control_name(char c);

/// The text on one line, for a terminal or a comment: control characters become \n, \t, \r or \x1b.
[[nodiscard]] std::string printable(std::string_view text);

} // namespace osculate
