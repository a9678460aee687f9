#include "osculate/scene/number_at.hpp"

#include "osculate/scene/units.hpp"
#include "scene/flow_text.hpp"
#include "scene/overrides.hpp"
#include "scene/tree.hpp"

#include <charconv>
#include <utility>
#include <vector>

namespace osculate::scene {

namespace {

std::optional<std::size_t> place_in(const Tree& list, const std::string& part) {
    std::size_t place = 0;
    const auto [end, error] = std::from_chars(part.data(), part.data() + part.size(), place);
    if (error != std::errc() || end != part.data() + part.size() || place >= list.children.size()) return std::nullopt;
    return place;
}

std::string joined(const std::vector<std::string>& parts, std::size_t count) {
    std::string path;
    for (std::size_t i = 0; i < count; ++i) path += (i == 0 ? "" : ".") + parts[i];
    return path;
}

} // namespace

std::optional<NumberAt> number_at(const std::string& resolved, const std::string& key, std::string& found) {
    std::vector<Fault> none;
    const Tree scene = parse_yaml(resolved, "the resolved scene", none);
    const std::vector<std::string> parts = split_path(key);
    const Tree* node = &scene;
    const Tree* list = nullptr;             // outermost on the way
    std::vector<std::size_t> places;        // within it
    std::size_t before_list = parts.size(); // parts that lead to it
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const Tree* next = nullptr;
        if (node->kind == Tree::Kind::list) {
            const std::optional<std::size_t> place = place_in(*node, parts[i]);
            if (list == nullptr) {
                list = node;
                before_list = i;
            }
            if (place) {
                next = &node->children[*place];
                places.push_back(*place);
            }
        } else {
            next = node->find(parts[i]);
        }
        if (next == nullptr || (list != nullptr && next->kind == Tree::Kind::map)) {
            found = "no '" + joined(parts, i + 1) + "' in the resolved scene";
            return std::nullopt;
        }
        node = next;
    }
    double value = 0;
    const std::string& text = node->scalar;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
    if (node->kind != Tree::Kind::scalar || error != std::errc() || end != text.data() + text.size()) {
        found = node->found();
        return std::nullopt;
    }
    if (list == nullptr) return NumberAt{value, [key](double other) { return Override{key, number_text(other)}; }};
    return NumberAt{value, [path = joined(parts, before_list), whole = *list, places](double other) {
                        Tree changed = whole;
                        Tree* at = &changed;
                        for (const std::size_t place : places) at = &at->children[place];
                        at->scalar = number_text(other);
                        return Override{path, flow_text(changed)};
                    }};
}

} // namespace osculate::scene
