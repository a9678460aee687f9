#pragma once
/// Which keys of a scene files give a value: scenes, studies, and overrides and pieces of scenes in the sources of tests.

#include "osculate/scene/keys.hpp"
#include "osculate/scene/units.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>
#include <yaml-cpp/yaml.h>

namespace osculate::scene {

class KeyUses {
public:
    using Path = std::vector<std::string>;

    KeyUses() {
        std::istringstream keys(describe_keys(""));
        for (std::string name, text; std::getline(keys, name) && std::getline(keys, text);) {
            Wanted key{split(name, '.'), default_of(text), {}};
            for (const char* kind : {"    one of ", "    list of "})
                for (const std::string& word : split(between(text, kind, ";"), ','))
                    if (trimmed(word) != key.default_text) key.words.push_back(trimmed(word));
            wanted_[name] = key;
        }
    }

    [[nodiscard]] std::set<std::string> wanted() const {
        std::set<std::string> all;
        for (const auto& [name, key] : wanted_) {
            all.insert(name);
            for (const std::string& word : key.words) all.insert(name + "=" + word);
        }
        return all;
    }
    [[nodiscard]] std::vector<std::string> untouched() const {
        const auto is_touched = [&](const std::string& key) { // itself, or what it holds
            const auto next = touched_.lower_bound(key);
            return next != touched_.end() && (*next == key || next->starts_with(key + "."));
        };
        std::vector<std::string> rest;
        std::ranges::remove_copy_if(wanted(), std::back_inserter(rest), is_touched);
        return rest;
    }

    /// Reads all below a folder, but scenes that are meant to be refused.
    void read_folder(const std::filesystem::path& folder) {
        for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
            if (!entry.is_regular_file()) continue;
            const std::filesystem::path& path = entry.path();
            const std::string stem = path.stem().string();
            if (path.parent_path().filename() == "bad" || stem.starts_with("bad_") || stem.starts_with("key_"))
                continue;
            std::ifstream file(path);
            const std::string text{std::istreambuf_iterator<char>(file), {}};
            if (path.extension() == ".yaml") read_yaml(text);
            if (path.extension() == ".cpp" || path.extension() == ".hpp") read_cpp(text);
        }
    }

    /// A scene, a study or a piece of a scene; text that is no YAML map says nothing.
    void read_yaml(const std::string& text) {
        try {
            const YAML::Node node = YAML::Load(text);
            if (node.IsMap()) walk(node, {});
        } catch (const YAML::Exception&) { // any text of a source may come here
        }
    }

    /// String literals: pieces of scenes, "key=value", and {"key", value}. A value that is no literal counts, and as every
    /// word that a literal of the file is.
    void read_cpp(const std::string& source) {
        const std::vector<Literal> literals = literals_of(source);
        std::vector<Path> computed;
        for (std::size_t i = 0; i < literals.size(); ++i) {
            const std::string& text = literals[i].text;
            const std::size_t equal = text.find('=');
            const std::string key = text.substr(0, equal);
            const bool map = equal != std::string::npos && text.substr(equal + 1).starts_with('{');
            if (!is_dotted(key) && !(map && wanted_.contains(key))) {
                if (text.find(':') != std::string::npos) read_yaml(text);
            } else if (equal != std::string::npos) {
                // "key=" + text is computed
                give(split(key, '.'), equal + 1 < text.size() ? text.substr(equal + 1) : "computed");
            } else if (source[literals[i].before] == '{' && source[literals[i].after] == ',') {
                const bool literal = i + 1 < literals.size() && literals[i + 1].before == literals[i].after;
                if (!literal) computed.push_back(split(key, '.'));
                give(split(key, '.'), literal ? literals[i + 1].text : "computed");
            }
        }
        for (const Literal& literal : literals)
            for (const Path& path : computed) give(path, literal.text, true);
    }

private:
    struct Wanted {
        Path path;
        std::string default_text; ///< empty where there is none
        Path words;               ///< what it can be or hold, but the default
    };
    struct Literal {
        std::string text;          ///< neighbours joined
        std::size_t before, after; ///< places of the characters of code around it
    };

    static Path split(const std::string& text, char separator) {
        Path parts;
        std::istringstream stream(text);
        for (std::string part; std::getline(stream, part, separator);) parts.push_back(part);
        return parts;
    }
    static std::string trimmed(const std::string& text) {
        const std::size_t first = text.find_first_not_of(" \t\n");
        return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\n") - first + 1);
    }
    static std::string between(const std::string& text, const std::string& from, const std::string& to) {
        const std::size_t at = text.find(from);
        if (at == std::string::npos) return "";
        return text.substr(at + from.size(), text.find(to, at) - at - from.size());
    }
    /// "...; default [0, 0, 0]. Meaning" or "...; default 0, which is flat. Meaning"
    static std::string default_of(const std::string& text) {
        const std::string value = between(text, "; default ", ". ");
        return value.substr(0, value.find(", which"));
    }
    static bool is_dotted(const std::string& text) {
        return text.find('.') != std::string::npos && std::ranges::all_of(text, [](unsigned char c) {
                   return std::isalnum(c) || c == '_' || c == '.' || c == '<' || c == '>';
               });
    }

    /// Numbers of a text in SI, other words as they are.
    static Path values(const std::string& text) {
        std::string flat = text;
        std::erase_if(flat, [](char c) { return c == '[' || c == ']' || c == '"'; });
        Path all;
        for (const std::string& part : split(flat, ',')) {
            const Quantity quantity = parse_quantity(trimmed(part));
            all.push_back(quantity.problem.empty() ? number_text(quantity.value) : trimmed(part));
        }
        return all;
    }

    static bool is_name(const std::string& segment) { return segment.starts_with('<'); }

    /// Whether a path from a scene's root, or from somewhere inside, leads to the key: at least two words of it must be
    /// there, or one that no other key ends with.
    [[nodiscard]] bool leads_to(const Path& path, const Path& key) const {
        if (path.empty() || path.size() > key.size()) return false;
        const std::size_t offset = key.size() - path.size();
        std::size_t words = 0;
        for (std::size_t i = 0; i < path.size(); ++i) {
            if (is_name(key[offset + i])) continue;
            if (path[i] != key[offset + i]) return false;
            ++words;
        }
        if (words > 1 || (offset == 0 && words > 0)) return true;
        return words == 1 && !is_name(key.back()) && std::ranges::count_if(wanted_, [&](const auto& other) {
                                                         return other.second.path.back() == key.back();
                                                     }) == 1;
    }

    void give(Path path, const std::string& value, bool only_words = false) {
        if (path.size() > 2 && path[0] == "contact" && path[1] != "general" && path[2] == "surface")
            path.insert(path.begin() + 2, "master");
        if (value.starts_with('{') && !only_words) // the value of an override may be a map
            try {
                return walk(YAML::Load(value), path);
            } catch (const YAML::Exception&) {
            }
        Path tag = path; // `surface: facets` is short for `surface: {facets: {}}`
        tag.push_back(value);
        const Path parts = values(value);
        for (const auto& [name, key] : wanted_) {
            if (leads_to(tag, key.path)) touched_.insert(name);
            if (!leads_to(path, key.path)) continue;
            if (!only_words && (key.default_text.empty() || parts != values(key.default_text))) touched_.insert(name);
            for (const std::string& word : key.words)
                if (std::ranges::count(parts, word) > 0) touched_.insert(name + "=" + word);
        }
    }

    void walk(const YAML::Node& node, const Path& path) {
        if (!node.IsMap()) {
            YAML::Emitter flow;
            flow << YAML::Flow << node;
            if (!path.empty()) give(path, node.IsScalar() ? node.as<std::string>() : flow.c_str());
            return;
        }
        for (const auto& [name, key] : wanted_)
            if (leads_to(path, key.path)) touched_.insert(name);
        if (node["key"] && node["values"]) // an axis of a study
            for (const auto& value : node["values"])
                if (value.IsScalar()) give(split(node["key"].as<std::string>(), '.'), value.as<std::string>());
        for (const auto& entry : node) {
            const auto key = entry.first.as<std::string>();
            Path deeper = is_dotted(key) ? Path{} : path;
            std::ranges::copy(split(key, '.'), std::back_inserter(deeper));
            walk(entry.second, deeper);
        }
    }

    static std::vector<Literal> literals_of(const std::string& source) {
        std::vector<Literal> literals;
        std::size_t code = 0;     // place of the last character of code
        bool just_behind = false; // a literal, or white space behind it
        const std::size_t size = source.size();
        const auto add = [&](const std::string& text) {
            if (just_behind)
                literals.back().text += text;
            else
                literals.push_back({text, code, size});
            just_behind = true;
        };
        for (std::size_t i = 0; i < size; ++i) {
            const std::string_view rest = std::string_view(source).substr(i);
            if (rest.starts_with("//")) {
                i = std::min(source.find('\n', i), size);
            } else if (rest.starts_with("R\"")) {
                const std::size_t open = source.find('(', i);
                const std::string close = ")" + source.substr(i + 2, open - i - 2) + "\"";
                const std::size_t end = std::min(source.find(close, open), size);
                add(source.substr(open + 1, end - open - 1));
                i = end + close.size() - 1;
            } else if (source[i] == '"') {
                std::string text;
                for (++i; i < size && source[i] != '"'; ++i) {
                    if (source[i] == '\\' && ++i < size)
                        text += source[i] == 'n' ? '\n' : source[i];
                    else
                        text += source[i];
                }
                add(text);
            } else if (!std::isspace(static_cast<unsigned char>(source[i]))) {
                if (just_behind) literals.back().after = i;
                just_behind = false;
                code = i;
                if (source[i] == '\'') // a character, which may be a quotation mark
                    for (++i; i < size && source[i] != '\''; ++i)
                        if (source[i] == '\\') ++i;
            }
        }
        if (!literals.empty()) literals.back().after = std::min(literals.back().after, size - 1);
        return literals;
    }

    std::map<std::string, Wanted> wanted_;
    std::set<std::string> touched_;
};

} // namespace osculate::scene
