#include "scene/flow_text.hpp"

#include <cctype>

namespace osculate::scene {

std::string flow_text(const Tree& tree) {
    if (tree.kind == Tree::Kind::scalar) {
        const bool plain =
            !tree.scalar.empty() && tree.scalar.find_first_of(",:[]{}#&*!|>'\"%@`\n") == std::string::npos;
        if (plain) return tree.scalar;
        std::string text = "'";
        for (const char c : tree.scalar) text += c == '\'' ? std::string("''") : std::string(1, c);
        return text + "'";
    }
    if (tree.kind == Tree::Kind::null) return "";
    const bool map = tree.kind == Tree::Kind::map;
    std::string text = map ? "{" : "[";
    for (const Tree& child : tree.children)
        text += (&child == &tree.children.front() ? "" : ", ") + (map ? child.key + ": " : "") + flow_text(child);
    return text + (map ? "}" : "]");
}

std::string name_of_value(const std::string& text) {
    std::string name;
    for (const char c : text) {
        const bool fits = std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '.';
        if (fits || ((c == '-' || c == '+') && name.empty()) ||
            (c == '-' && std::isalpha(static_cast<unsigned char>(name.back()))))
            name += c == '+' ? '-' : c;
        else if (!name.empty() && name.back() != '-')
            name += '-';
    }
    while (!name.empty() && name.back() == '-') name.pop_back();
    return name;
}

} // namespace osculate::scene
