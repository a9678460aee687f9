#include "osculate/mesh/deck.hpp"

#include "mesh/deck/assembly.hpp"
#include "osculate/core/file_content.hpp"
#include "osculate/mesh/mesh_error.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace osculate::mesh {
namespace {

constexpr int deepest = 10;
constexpr std::uintmax_t most_bytes = 4'000'000'000; // of all files of a deck together
constexpr std::size_t most_parameters = 100;

bool is_blank(char c) {
    return c == ' ' || c == '\t' || c == '\r' || c == '\f' || c == '\v';
}

char capital(char c) {
    return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c;
}

/// Without the quotes around it, where there are just these.
std::string_view within_quotes(std::string_view text) {
    const bool quoted = text.size() >= 2 && text.front() == '"' && text.find('"', 1) == text.size() - 1;
    return quoted ? text.substr(1, text.size() - 2) : text;
}

std::size_t comma_outside_quotes(std::string_view text) {
    bool inside = false;
    for (std::size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '"') inside = !inside;
        if (text[i] == ',' && !inside) return i;
    }
    return std::string_view::npos;
}

class Parser {
public:
    explicit Parser(bool includes) : includes_(includes) {}

    void file(const std::filesystem::path& path, const std::string& from, int depth) {
        std::error_code error;
        const auto fail = [&](const std::string& why) {
            throw MeshError(from.empty() ? path.string() : from, from.empty() ? why : path.string() + ": " + why);
        };
        if (!std::filesystem::is_regular_file(path, error)) fail("no such file");
        const std::uintmax_t size = std::filesystem::file_size(path, error);
        if (error) fail("cannot be read");
        if ((total_ += size) > most_bytes) fail("decks of more than 4 GB are not read");
        if (depth > deepest) fail("*INCLUDE nested deeper than 10");
        auto content = std::make_shared<const std::string>(file_content(path, error));
        if (error) fail("cannot be read");
        text(std::move(content), path.string(), path.parent_path(), depth);
    }

    void text(std::shared_ptr<const std::string> content, const std::string& name, const std::filesystem::path& folder,
              int depth) {
        const auto number = static_cast<int>(deck.files.size());
        deck.files.push_back(name);
        deck.texts.push_back(content);
        std::string_view rest = *content;
        int line = 0;
        const auto next = [&] {
            const std::size_t end = rest.find('\n');
            const std::string_view one = trimmed(rest.substr(0, end));
            rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
            ++line;
            return one;
        };
        while (!rest.empty()) {
            std::string_view one = next();
            if (one.empty() || one.starts_with("**")) continue;
            if (one.front() != '*') {
                if (deck.cards.empty()) throw MeshError(deck.place(number, line), "data before any keyword");
                deck.lines.push_back({one, line, number, one});
                deck.cards.back().last = deck.lines.size();
                continue;
            }
            const int first = line;
            std::string words(one.substr(1));
            while (words.ends_with(',') && !rest.empty()) { // continued
                one = next();
                if (one.starts_with('*') && !one.starts_with("**"))
                    throw MeshError(deck.place(number, line), "a keyword, although the one before has to be continued");
                if (!one.starts_with("**")) words += one;
                if (one.empty()) break;
            }
            DeckCard made = card(words, first, number);
            if (made.keyword == "INCLUDE" && includes_) {
                const std::string* input = made.parameter("INPUT");
                if (input == nullptr || input->empty())
                    throw MeshError(deck.place(number, first), "*INCLUDE without INPUT=file");
                file(folder / *input, deck.place(number, first), depth + 1);
                continue;
            }
            deck.cards.push_back(std::move(made));
        }
    }

    Deck deck;

private:
    DeckCard card(std::string_view words, int line, int file) {
        DeckCard card;
        card.line = line;
        card.file = file;
        card.first = card.last = deck.lines.size();
        std::vector<std::string_view> fields;
        split_fields(words, fields);
        if (fields.size() > most_parameters) throw MeshError(deck.place(file, line), "too many parameters");
        for (std::size_t f = 0; f < fields.size(); ++f) {
            if (f == 0) {
                for (const char c : fields[0]) {
                    if (is_blank(c) && card.keyword.ends_with(' ')) continue;
                    card.keyword += is_blank(c) ? ' ' : capital(c);
                }
                continue;
            }
            const std::size_t equals = fields[f].find('=');
            std::string name = in_capitals(fields[f].substr(0, equals));
            std::erase_if(name, is_blank);
            card.parameters.emplace_back(std::move(name),
                                         equals == std::string_view::npos
                                             ? ""
                                             : std::string(within_quotes(trimmed(fields[f].substr(equals + 1)))));
        }
        return card;
    }

    bool includes_;
    std::uintmax_t total_ = 0;
};

} // namespace

const std::string* DeckCard::parameter(std::string_view name) const {
    for (const auto& [key, value] : parameters)
        if (key == name) return &value;
    return nullptr;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
    return text;
}

std::string in_capitals(std::string_view text) {
    std::string capitals(text);
    std::transform(capitals.begin(), capitals.end(), capitals.begin(), capital);
    return capitals;
}

void split_fields(std::string_view line, std::vector<std::string_view>& fields) {
    fields.clear();
    const bool quotes = line.find('"') != std::string_view::npos;
    while (!line.empty()) {
        const std::size_t comma = quotes ? comma_outside_quotes(line) : line.find(',');
        fields.push_back(trimmed(line.substr(0, comma)));
        if (quotes) fields.back() = within_quotes(fields.back());
        line = comma == std::string_view::npos ? std::string_view() : line.substr(comma + 1);
        if (trimmed(line).empty()) break;
    }
}

bool to_number(std::string_view text, double& value) {
    if (text.starts_with('+')) text.remove_prefix(1);
    std::array<char, 64> buffer{};
    if (text.empty() || text.size() >= buffer.size()) return false;
    std::copy(text.begin(), text.end(), buffer.begin());
    for (std::size_t i = 0; i < text.size(); ++i)
        if (buffer[i] == 'D' || buffer[i] == 'd') buffer[i] = 'e';
    const auto [end, error] = std::from_chars(buffer.data(), buffer.data() + text.size(), value);
    return error == std::errc() && end == buffer.data() + text.size() && std::isfinite(value);
}

bool to_integer(std::string_view text, long long& value) {
    if (text.starts_with('+')) text.remove_prefix(1);
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    return error == std::errc() && end == text.data() + text.size();
}

Deck read_deck(const std::filesystem::path& path) {
    Parser parser(true);
    parser.file(path, "", 0);
    return without_parts(std::move(parser.deck));
}

Deck parse_deck(std::string text, const std::string& name) {
    Parser parser(false);
    parser.text(std::make_shared<const std::string>(std::move(text)), name, {}, 0);
    return without_parts(std::move(parser.deck));
}

} // namespace osculate::mesh
