#include "app/shell_words.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fmt/format.h>

namespace osculate::app {

std::string shell_word(const std::string& word) {
    const auto plain = [](unsigned char c) {
        return std::isalnum(c) != 0 || std::string("_-./=,:+@%").find(static_cast<char>(c)) != std::string::npos;
    };
    if (!word.empty() && std::ranges::all_of(word, plain)) return word;
    if (std::ranges::none_of(word, [](unsigned char c) { return c < ' '; })) {
        std::string text = "'";
        for (const char c : word) text += c == '\'' ? std::string("'\\''") : std::string(1, c);
        return text + "'";
    }
    std::string text = "$'";
    for (const char c : word)
        if (static_cast<unsigned char>(c) < ' ')
            text += fmt::format("\\{:03o}", static_cast<unsigned char>(c));
        else
            text += c == '\'' || c == '\\' ? std::string("\\") + c : std::string(1, c);
    return text + "'";
}

std::string shell_line(const std::vector<std::string>& words) {
    std::string line;
    for (const std::string& word : words) line += (line.empty() ? "" : " ") + shell_word(word);
    return line;
}

std::string job_name(std::string name) {
    for (char& c : name)
        if (std::isalnum(static_cast<unsigned char>(c)) == 0 && c != '_' && c != '-' && c != '.') c = '_';
    return name;
}

std::string this_program() {
    return std::filesystem::read_symlink("/proc/self/exe").string();
}

} // namespace osculate::app
