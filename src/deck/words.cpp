#include "deck/words.hpp"

#include <cctype>
#include <fmt/format.h>

namespace osculate::deck {

std::string scene_name(const std::string& name) {
    std::string fit;
    for (const char c : name) {
        const bool good =
            (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '_' || c == '-';
        fit += good ? c : '_';
    }
    constexpr std::size_t longest = 60;
    fit = fit.substr(0, longest);
    if (fit.empty() || !std::isalpha(static_cast<unsigned char>(fit.front()))) fit = "n" + fit;
    return fit;
}

std::string fresh_name(const std::string& wanted, std::set<std::string>& taken) {
    std::string name = scene_name(wanted);
    for (int k = 2; !taken.insert(name).second; ++k) name = scene_name(wanted) + "_" + std::to_string(k);
    return name;
}

std::string in_quotes(const std::string& text) {
    std::string result = "\"";
    for (const char c : text) {
        const auto code = static_cast<unsigned char>(c);
        if (c == '"' || c == '\\')
            result += std::string("\\") + c;
        else if (code < 0x20 || code == 0x7f)
            result += fmt::format("\\x{:02x}", code);
        else
            result += c;
    }
    return result + "\"";
}

std::string number(double value) {
    return fmt::format("{:.12g}", value);
}

std::string course(double value, const Amplitude* factors) {
    if (factors == nullptr) return number(value);
    std::string rows;
    for (const auto& [t, factor] : *factors)
        rows += (rows.empty() ? "[" : ", [") + number(t) + ", " + number(factor * value) + "]";
    return "{table: [" + rows + "]}";
}

std::string harmless(const std::string& text) {
    std::string result = text;
    for (char& c : result)
        if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = ' ';
    return result;
}

} // namespace osculate::deck
