#include "osculate/core/printable.hpp"

namespace osculate {

namespace {

std::string escape(char c) {
    constexpr const char* digits = "0123456789abcdef";
    const auto code = static_cast<unsigned char>(c);
    switch (c) {
    case '\n': return "\\n";
    case '\t': return "\\t";
    case '\r': return "\\r";
    default: return {'\\', 'x', digits[code / 16], digits[code % 16]};
    }
}

} // namespace

std::size_t find_control(std::string_view text, std::string_view allowed) {
    for (std::size_t i = 0; i < text.size(); ++i)
        if (is_control(text[i]) && allowed.find(text[i]) == std::string_view::npos) return i;
    return std::string_view::npos;
}

std::string control_name(char c) {
    switch (c) {
    case '\n': return "a line break";
    case '\t': return "a tab";
    default: return "the character " + escape(c);
    }
}

std::string printable(std::string_view text) {
    std::string result;
    for (const char c : text) result += is_control(c) ? escape(c) : std::string(1, c);
    return result;
}

} // namespace osculate
