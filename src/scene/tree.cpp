#include "scene/tree.hpp"

#include "osculate/core/file_content.hpp"
#include "osculate/core/printable.hpp"

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <unordered_map>
#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/yaml.h>

namespace osculate::scene {

namespace {

constexpr int max_depth = 64;
constexpr int max_nodes = 500000; ///< aliases of aliases grow without bound

/// Copies yaml-cpp's nodes into a Tree.
class Copier {
public:
    Copier(const std::string& file, const std::vector<std::string>& with_lines, std::vector<Fault>& faults)
        : file_(file), with_lines_(with_lines), faults_(faults) {}

    Tree copy(const YAML::Node& node, const std::string& path, int depth = 0) {
        Tree tree;
        tree.place = place_of(node);
        if (depth > max_depth || ++nodes_ > max_nodes) {
            if (!overflow_)
                faults_.push_back(fault_at(tree.place, path,
                                           "at most " + std::to_string(max_depth) + " levels and " +
                                               std::to_string(max_nodes) + " values",
                                           "more"));
            overflow_ = true;
            return tree;
        }
        switch (node.Type()) {
        case YAML::NodeType::Scalar:
            tree.kind = Tree::Kind::scalar;
            tree.scalar = checked(node.Scalar(), tree.place, path, std::ranges::count(with_lines_, path) > 0);
            break;
        case YAML::NodeType::Sequence:
            tree.kind = Tree::Kind::list;
            for (const auto& item : node) {
                if (overflow_) break;
                tree.children.push_back(copy(item, path, depth + 1));
            }
            break;
        case YAML::NodeType::Map: copy_map(node, tree, path, depth); break;
        default: break;
        }
        return tree;
    }

private:
    Place place_of(const YAML::Node& node) const {
        const YAML::Mark mark = node.Mark();
        if (mark.is_null()) return {file_, 0, 0};
        return {file_, mark.line + 1, mark.column + 1};
    }

    /// A text, or a fault and what can be shown of it: names and titles reach terminals, tables and scripts, where a
    /// control character ends the line or the string that they stand in.
    std::string checked(const std::string& text, const Place& place, const std::string& path, bool lines) {
        const std::size_t at = find_control(text, lines ? "\n" : "");
        if (at == std::string::npos) return text;
        std::string shown = printable(text);
        constexpr std::size_t longest = 80;
        if (shown.size() > longest) shown = shown.substr(0, longest) + "...";
        faults_.push_back(
            fault_at(place, path,
                     lines ? "a text without control characters except line breaks"
                           : "a text on one line, without control characters",
                     "'" + shown + "' (" + control_name(text[at]) + ", " + std::to_string(at + 1) + ". character)"));
        return printable(text);
    }

    void copy_map(const YAML::Node& node, Tree& tree, const std::string& path, int depth) {
        tree.kind = Tree::Kind::map;
        std::vector<YAML::Node> merged;
        std::unordered_map<std::string, int> line_of;
        for (const auto& entry : node) {
            if (overflow_) return;
            const Place key_place = place_of(entry.first);
            if (!entry.first.IsScalar()) {
                faults_.push_back(fault_at(key_place, path, "a name as a key", "something else"));
                continue;
            }
            if (entry.first.Scalar() == "<<") {
                merged.push_back(entry.second);
                continue;
            }
            const std::string key = checked(entry.first.Scalar(), key_place, path, false);
            const std::string inside = path.empty() ? key : path + "." + key;
            if (const auto [first, is_new] = line_of.emplace(key, key_place.line); !is_new) {
                faults_.push_back(
                    fault_at(key_place, inside, "every key once",
                             "'" + key + "' again (first in line " + std::to_string(first->second) + ")"));
                continue;
            }
            Tree value = copy(entry.second, inside, depth + 1);
            value.key = key;
            value.key_place = key_place;
            tree.children.push_back(std::move(value));
        }
        for (const YAML::Node& other : merged) merge(other, tree, path, depth + 1);
    }

    /// Adds the keys of `<<: *other`, or of a list of such maps, that a map does not have (yaml.org/type/merge.html).
    void merge(const YAML::Node& other, Tree& tree, const std::string& path, int depth) {
        if (other.IsSequence() && depth <= max_depth) {
            for (const auto& one : other) merge(one, tree, path, depth + 1);
            return;
        }
        if (!other.IsMap()) {
            faults_.push_back(fault_at(place_of(other), path.empty() ? "<<" : path + ".<<",
                                       "a map to merge, or a list of maps", "something else"));
            return;
        }
        Tree more = copy(other, path, depth);
        for (Tree& child : more.children)
            if (tree.find(child.key) == nullptr) tree.children.push_back(std::move(child));
    }

    const std::string& file_;
    const std::vector<std::string>& with_lines_;
    std::vector<Fault>& faults_;
    int nodes_ = 0;
    bool overflow_ = false;
};

/// Remembers where the last document began.
class DocumentStart final : public YAML::EventHandler {
public:
    [[nodiscard]] const YAML::Mark& mark() const { return mark_; }

    void OnDocumentStart(const YAML::Mark& mark) override { mark_ = mark; }
    void OnDocumentEnd() override {}
    void OnNull(const YAML::Mark&, YAML::anchor_t) override {}
    void OnAlias(const YAML::Mark&, YAML::anchor_t) override {}
    void OnScalar(const YAML::Mark&, const std::string&, YAML::anchor_t, const std::string&) override {}
    void OnSequenceStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
    void OnSequenceEnd() override {}
    void OnMapStart(const YAML::Mark&, const std::string&, YAML::anchor_t, YAML::EmitterStyle::value) override {}
    void OnMapEnd() override {}

private:
    YAML::Mark mark_ = YAML::Mark::null_mark();
};

/// Of a text that is to be shown in a message.
std::string shortened(const std::string& text) {
    constexpr std::size_t longest = 120;
    if (text.size() <= longest) return text;
    std::size_t end = longest;
    while (end > 0 && (static_cast<unsigned char>(text[end]) & 0xC0U) == 0x80U) --end; // not within a character
    return text.substr(0, end) + "...";
}

/// What yaml-cpp's messages do not name, as far as lines tell; null: nothing.
struct Suspect {
    const char* what = nullptr;
    int line = 0, column = 0;
};
Suspect suspect(const std::string& text) {
    std::istringstream stream(text);
    Suspect open;
    std::string line;
    for (int number = 1; std::getline(stream, line); ++number) {
        const std::size_t first = line.find_first_not_of(" \t");
        const std::size_t tab = line.substr(0, first == std::string::npos ? 0 : first).find('\t');
        if (tab != std::string::npos && line[first] != '#')
            return {"a tab in front of a line; YAML takes spaces", number, static_cast<int>(tab) + 1};
        if (const std::size_t comment = line.find(" #"); comment != std::string::npos) line.resize(comment);
        if (line.starts_with('#')) continue;
        const auto quotes = std::ranges::count(line, '"') - (line.find("\\\"") == std::string::npos ? 0 : 1);
        if (open.what == nullptr && quotes % 2 != 0)
            open = {"a quote that this line does not close", number, static_cast<int>(line.find('"')) + 1};
    }
    return open;
}

} // namespace

const Tree* Tree::find(std::string_view name) const {
    if (kind != Kind::map) return nullptr;
    for (const Tree& child : children)
        if (child.key == name) return &child;
    return nullptr;
}

Tree* Tree::find(std::string_view name) {
    return const_cast<Tree*>(static_cast<const Tree*>(this)->find(name));
}

std::string Tree::found() const {
    switch (kind) {
    case Kind::scalar: return "'" + shortened(scalar) + "'";
    case Kind::list: return "a list of " + std::to_string(children.size());
    case Kind::map: return "a map";
    case Kind::null: break;
    }
    return "nothing";
}

Fault fault_at(const Place& place, std::string key, std::string expected, std::string found, std::string nearest_name) {
    return {place.file,          place.line,       place.column,           std::move(key),
            std::move(expected), std::move(found), std::move(nearest_name)};
}

std::string join(const std::vector<std::string>& words, const char* separator) {
    constexpr std::size_t longest = 24;
    std::string text;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i == longest) return text + separator + "...";
        text += (i == 0 ? "" : separator) + words[i];
    }
    return text;
}

Tree parse_yaml(const std::string& text, const std::string& file, std::vector<Fault>& faults,
                const std::vector<std::string>& with_lines) {
    try {
        std::istringstream stream(text);
        YAML::Parser parser(stream);
        DocumentStart start;
        parser.HandleNextDocument(start);
        if (parser) { // YAML::LoadAll never returns from some such texts, YAML::Load drops what follows
            parser.HandleNextDocument(start);
            faults.push_back(fault_at({file, start.mark().line + 1, start.mark().column + 1}, "",
                                      "the end of the document", "more text"));
            return {.place = {file, 1, 1}};
        }
        Tree tree = Copier(file, with_lines, faults).copy(YAML::Load(text), "");
        if (tree.place.line == 0) tree.place = {file, 1, 1};
        return tree;
    } catch (const YAML::Exception& error) {
        Place place{file, 0, 0};
        if (!error.mark.is_null()) place = {file, error.mark.line + 1, error.mark.column + 1};
        faults.push_back(fault_at(place, "", "valid YAML", error.msg));
        if (const Suspect found = suspect(text); found.what != nullptr)
            faults.push_back(fault_at({file, found.line, found.column}, "", "valid YAML", found.what));
    } catch (const std::runtime_error& error) { // yaml-cpp's guard against deep nesting
        faults.push_back(fault_at({file, 0, 0}, "", "valid YAML", error.what()));
    }
    return {.place = {file, 1, 1}};
}

Tree read_yaml(const std::string& path, std::vector<Fault>& faults, const std::vector<std::string>& with_lines) {
    const Tree nothing{.place = {path, 0, 0}};
    std::error_code ignored;
    if (std::filesystem::is_directory(path, ignored)) {
        faults.push_back(fault_at({path, 0, 0}, "", "a YAML file", "a folder"));
        return nothing;
    }
    std::error_code error;
    const std::string text = file_content(path, error);
    if (error) {
        const char* found = error == std::errc::timed_out        ? "a pipe that no program writes to"
                            : error == std::errc::file_too_large ? "a stream of more than 256 MB"
                                                                 : nullptr;
        faults.push_back(fault_at({path, 0, 0}, "", "a readable file", found != nullptr ? found : error.message()));
        return nothing;
    }
    return parse_yaml(text, path, faults, with_lines);
}

} // namespace osculate::scene
