#include "scene/tree_reader.hpp"

#include "osculate/scene/nearest.hpp"
#include "scene/article.hpp"
#include "scene/frame.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <unordered_set>

namespace osculate::scene {

namespace {

std::string expected_integer(const Key& key) {
    const std::string bounds = key.range.text();
    return "a whole number" + (bounds.empty() ? "" : " " + bounds);
}

std::string expected_vector(const Key& key) {
    if (key.direction) return "a list of three numbers, not all zero";
    return "a list of three, each " + expected_number(key);
}

bool is_true(const Tree& tree) {
    return tree.kind == Tree::Kind::scalar && (tree.scalar == "true" || tree.scalar == "yes");
}

bool is_false(const Tree& tree) {
    return tree.kind == Tree::Kind::scalar && (tree.scalar == "false" || tree.scalar == "no");
}

bool is_identifier(const std::string& name) {
    const auto fits = [](unsigned char c) { return std::isalnum(c) || c == '_' || c == '-'; };
    return !name.empty() && name.front() != '-' && std::ranges::all_of(name, fits);
}

constexpr double shortest_direction = 1e-12;

} // namespace

std::string expected_number(const Key& key) {
    std::string text = with_article(name_of(key.unit));
    if (key.unit != dimension::none) text += " (" + unit_of(key.unit) + ")";
    if (const std::string bounds = key.range.text(); !bounds.empty()) text += " " + bounds;
    if (key.not_whole) text += ", not whole";
    return text;
}

std::string Range::text() const {
    const bool bounded_low = std::isfinite(low), bounded_high = std::isfinite(high);
    if (bounded_low && bounded_high)
        return std::string("in ") + (open_low ? "(" : "[") + number_text(low) + ", " + number_text(high) +
               (open_high ? ")" : "]");
    if (bounded_low) return (open_low ? "> " : ">= ") + number_text(low);
    if (bounded_high) return (open_high ? "< " : "<= ") + number_text(high);
    return {};
}

// ---- the current map -------------------------------------------------------------------------------------------------

std::string TreeReader::path_of(const std::string& name) const {
    return levels_.back().path.empty() ? name : levels_.back().path + "." + name;
}

void TreeReader::fault(const Tree& at, const Key& key, std::string expected, std::string found, std::string near) {
    if (found.empty()) found = at.found();
    faults_.push_back(fault_at(at.place, path_of(key.name), std::move(expected), std::move(found), std::move(near)));
}

const Tree* TreeReader::Level::find(const std::string& name) const {
    if (of_many.empty()) return map->find(name);
    const auto at = of_many.find(name);
    return at == of_many.end() ? nullptr : at->second;
}

const Tree* TreeReader::take(const Key& key, const std::string& expected) {
    Level& level = levels_.back();
    level.known.push_back(key.name);
    const Tree* value = level.find(key.name);
    if (!value && key.required && key.instead == nullptr) fault(*level.map, key, expected, "nothing");
    return value;
}

void TreeReader::leave(const Level& level) {
    bool misspelt = false; // a misspelt tag is reported as an unknown key, not as a missing choice too
    const std::unordered_set<std::string_view> known(level.known.begin(), level.known.end());
    for (const Tree& child : level.map->children) {
        if (known.contains(child.key)) continue;
        misspelt = misspelt || !nearest(child.key, level.missing_choice).empty();
        const std::string path = level.path.empty() ? child.key : level.path + "." + child.key;
        faults_.push_back(fault_at(child.key_place, path, "one of the keys " + join(level.known),
                                   "unknown key '" + child.key + "'", nearest(child.key, level.known)));
    }
    if (!level.missing_choice.empty() && !misspelt)
        faults_.push_back(fault_at(level.map->place, level.path, "one of " + join(level.missing_choice), "none"));
}

void TreeReader::enter(const Tree& map, std::string path, const std::function<void()>& body) {
    constexpr std::size_t many = 100;
    levels_.push_back({.map = &map, .path = std::move(path)});
    if (map.children.size() > many)
        for (const Tree& child : map.children) levels_.back().of_many.emplace(child.key, &child);
    body();
    const Level level = std::move(levels_.back());
    levels_.pop_back();
    leave(level);
}

void TreeReader::read(const Tree& document, const std::function<void()>& body) {
    Tree empty{.kind = Tree::Kind::map, .place = document.place};
    if (document.kind != Tree::Kind::map && document.kind != Tree::Kind::null)
        faults_.push_back(fault_at(document.place, "", "a map of keys", document.found()));
    enter(document.kind == Tree::Kind::map ? document : empty, "", body);
}

// ---- single values ---------------------------------------------------------------------------------------------------

std::optional<double> TreeReader::read_number(const Tree& tree, const Key& key, const std::string& expected) {
    if (tree.kind != Tree::Kind::scalar) {
        fault(tree, key, expected);
        return {};
    }
    const Quantity quantity = parse_quantity(tree.scalar);
    const auto reject = [&](const std::string& why) -> std::optional<double> {
        fault(tree, key, expected, tree.found() + (why.empty() ? "" : " (" + why + ")"), quantity.nearest);
        return {};
    };
    if (!quantity.problem.empty()) return reject(quantity.problem);
    if (quantity.has_unit && quantity.dimension != key.unit) return reject(name_of(quantity.dimension));
    if (!std::isfinite(quantity.value)) return reject("not finite");
    if (!key.range.contains(quantity.value)) return reject("");
    if (key.not_whole && quantity.value == std::round(quantity.value)) return reject("whole");
    return quantity.value;
}

std::optional<int> TreeReader::read_integer(const Tree& tree, const Key& key, const std::string& expected) {
    int value = 0;
    if (tree.kind == Tree::Kind::scalar) {
        const char* end = tree.scalar.data() + tree.scalar.size();
        const auto [stop, error] = std::from_chars(tree.scalar.data(), end, value);
        if (error == std::errc{} && stop == end && key.range.contains(value)) return value;
    }
    fault(tree, key, expected);
    return {};
}

std::optional<Vec3> TreeReader::read_vector(const Tree& tree, const Key& key) {
    const std::string expected = expected_vector(key);
    if (tree.kind != Tree::Kind::list || tree.children.size() != 3) {
        fault(tree, key, expected);
        return {};
    }
    Vec3 value = Vec3::Zero();
    bool complete = true;
    for (Eigen::Index i = 0; i < 3; ++i) {
        const auto component = read_number(tree.children[static_cast<std::size_t>(i)], key, expected);
        complete = complete && component;
        value[i] = component.value_or(0);
    }
    if (!complete) return {};
    if (key.direction && value.norm() < shortest_direction) {
        fault(tree, key, expected, "a zero vector");
        return {};
    }
    return value;
}

void TreeReader::number(const Key& key, double& value) {
    const std::string expected = expected_number(key);
    if (const Tree* tree = take(key, expected)) value = read_number(*tree, key, expected).value_or(value);
}

void TreeReader::optional_number(const Key& key, std::optional<double>& value) {
    const std::string expected = expected_number(key);
    if (const Tree* tree = take(key, expected)) value = read_number(*tree, key, expected);
}

void TreeReader::optional_relative_length(const Key& key, std::optional<RelativeLength>& value) {
    Key length = key;
    length.unit = dimension::length;
    length.range = range::size;
    const std::string expected = expected_number(key) + ", or " + expected_number(length) + " with its unit";
    const Tree* tree = take(key, expected);
    if (!tree) return;
    const bool metres = tree->kind == Tree::Kind::scalar && parse_quantity(tree->scalar).has_unit;
    const auto read = read_number(*tree, metres ? length : key, expected);
    value = read ? std::optional(RelativeLength{*read, metres}) : std::nullopt;
}

void TreeReader::vector(const Key& key, Vec3& value) {
    if (const Tree* tree = take(key, expected_vector(key))) value = read_vector(*tree, key).value_or(value);
}

void TreeReader::optional_vector(const Key& key, std::optional<Vec3>& value) {
    if (const Tree* tree = take(key, expected_vector(key))) value = read_vector(*tree, key);
}

void TreeReader::integer(const Key& key, int& value) {
    const std::string expected = expected_integer(key);
    if (const Tree* tree = take(key, expected)) value = read_integer(*tree, key, expected).value_or(value);
}

void TreeReader::divisions(const Key& key, std::array<int, 3>& value) {
    const std::string expected = "a list of three, each " + expected_integer(key);
    const Tree* tree = take(key, expected);
    if (!tree) return;
    if (tree->kind != Tree::Kind::list || tree->children.size() != 3) return fault(*tree, key, expected);
    std::array<int, 3> read = value;
    double product = 1;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto division = read_integer(tree->children[i], key, expected);
        if (!division) product = 0;
        read[i] = division.value_or(1);
        product *= read[i];
    }
    if (product > key.largest_product)
        return fault(*tree, key, "at most " + number_text(key.largest_product) + " elements", number_text(product));
    if (product > 0) value = read;
}

void TreeReader::integers(const Key& key, std::vector<int>& value) {
    const std::string expected = "a list, each " + expected_integer(key);
    const Tree* tree = take(key, expected);
    if (!tree) return;
    if (tree->kind != Tree::Kind::list || tree->children.empty()) return fault(*tree, key, expected);
    std::vector<int> read;
    for (const Tree& child : tree->children)
        if (const auto one = read_integer(child, key, expected)) read.push_back(*one);
    if (read.size() == tree->children.size()) value = std::move(read);
}

void TreeReader::flag(const Key& key, bool& value) {
    const std::string expected = "true or false";
    const Tree* tree = take(key, expected);
    if (!tree) return;
    if (is_true(*tree))
        value = true;
    else if (is_false(*tree))
        value = false;
    else
        fault(*tree, key, expected);
}

Words TreeReader::referred(Names names) const {
    if (names == Names::set) return names_.sets;
    if (names == Names::pair) return names_.pairs;
    Words known = names_.bodies;
    if (names == Names::rigid) known.insert(known.end(), names_.couplings.begin(), names_.couplings.end());
    return known;
}

bool TreeReader::check_name(const Tree& at, const Place& place, const Key& key, const std::string& name, Names names) {
    const auto reject = [&](std::string expected, std::string near) {
        faults_.push_back(fault_at(place, path_of(key.name), std::move(expected), at.found(), std::move(near)));
        return false;
    };
    if (names == Names::any) return true;
    if (names == Names::identifier) return is_identifier(name) || reject("a name of letters, digits, _ and -", "");
    const Words known = referred(names);
    if (std::ranges::count(known, name) > 0) return true;
    if ((names == Names::body || names == Names::rigid) && known.empty())
        return true; // a scene without bodies is one fault, not many
    const std::string what = names == Names::body    ? "body"
                             : names == Names::rigid ? "body or coupling"
                             : names == Names::pair  ? "pair"
                                                     : "set";
    return reject(known.empty() ? "the name of a " + what + " (there is none)"
                                : "the name of a " + what + ": " + join(known),
                  nearest(name, known));
}

void TreeReader::text(const Key& key, std::string& value) {
    const std::string expected = key.names == Names::body   ? "the name of a body"
                                 : key.names == Names::set  ? "the name of a set"
                                 : key.names == Names::pair ? "the name of a pair"
                                                            : "a text";
    const Tree* tree = take(key, expected);
    if (!tree) return;
    if (tree->kind != Tree::Kind::scalar || (key.required && tree->scalar.empty())) return fault(*tree, key, expected);
    if (check_name(*tree, tree->place, key, tree->scalar, key.names)) value = tree->scalar;
}

void TreeReader::two_names(const Key& key, std::array<std::string, 2>& value) {
    const std::string expected =
        std::string("a list of the names of two ") + (key.names == Names::set ? "sets" : "bodies or finishes");
    const Tree* tree = take(key, expected);
    if (!tree) return;
    if (tree->kind != Tree::Kind::list || tree->children.size() != 2) return fault(*tree, key, expected);
    for (std::size_t i = 0; i < 2; ++i) {
        const Tree& name = tree->children[i];
        if (name.kind != Tree::Kind::scalar)
            fault(name, key, expected);
        else if (check_name(name, name.place, key, name.scalar, key.names))
            value[i] = name.scalar;
    }
}

void TreeReader::word(const Key& key, const Words& vocabulary, std::size_t& index) {
    const std::string expected = "one of " + join(vocabulary);
    const Tree* tree = take(key, expected);
    if (!tree) return;
    const auto at = std::ranges::find(vocabulary, tree->scalar);
    if (tree->kind != Tree::Kind::scalar || at == vocabulary.end())
        return fault(*tree, key, expected, {}, nearest(tree->scalar, vocabulary));
    index = static_cast<std::size_t>(at - vocabulary.begin());
}

void TreeReader::words(const Key& key, const Words& vocabulary, std::vector<std::string>& value) {
    const std::string expected = "a list of " + join(vocabulary);
    const Tree* tree = take(key, expected);
    if (!tree) return;
    if (tree->kind != Tree::Kind::list) return fault(*tree, key, expected);
    value.clear();
    for (const Tree& item : tree->children) {
        const bool scalar = item.kind == Tree::Kind::scalar;
        if (!scalar || std::ranges::count(vocabulary, item.scalar) == 0)
            fault(item, key, expected, {}, nearest(item.scalar, vocabulary));
        else if (std::ranges::count(value, item.scalar) > 0)
            fault(item, key, expected + ", each once");
        else
            value.push_back(item.scalar);
    }
}

void TreeReader::points(const Key& key, std::vector<Vec3>& value) {
    const std::string expected = "a list of two points or more, each " + expected_vector(key);
    const Tree* tree = take(key, expected);
    if (!tree) return;
    if (tree->kind != Tree::Kind::list || tree->children.size() < 2) return fault(*tree, key, expected);
    std::vector<Vec3> read;
    for (const Tree& child : tree->children)
        if (const auto point = read_vector(child, key)) read.push_back(*point);
    if (read.size() == tree->children.size()) value = std::move(read);
}

void TreeReader::axes(const Key& key, Mat3& value) {
    const std::string expected = "a list of two directions that are not parallel";
    const Tree* tree = take(key, expected);
    if (!tree) return;
    if (tree->kind != Tree::Kind::list || tree->children.size() != 2) return fault(*tree, key, expected);
    Key direction = key;
    direction.direction = true;
    direction.range = range::direction;
    const auto first = read_vector(tree->children[0], direction), second = read_vector(tree->children[1], direction);
    if (!first || !second) return;
    const auto frame = frame_of(*first, *second);
    if (!frame) return fault(*tree, key, expected, "parallel directions");
    value = *frame;
}

// ---- maps --------------------------------------------------------------------------------------------------------------

void TreeReader::group(const Key& key, const std::function<void()>& body) {
    const std::string expected = key.bare_flag ? "true, false or a map of keys" : "a map of keys";
    const Tree* tree = take(key, expected);
    if (!tree) return;
    Tree map{.kind = Tree::Kind::map, .place = tree->place};
    if (key.bare_word && tree->kind == Tree::Kind::scalar) {
        map.children.push_back({.key = tree->scalar, .place = tree->place, .key_place = tree->place});
        tree = &map;
    } else if (tree->kind == Tree::Kind::null || (key.bare_flag && is_true(*tree))) {
        tree = &map;
    } else if (tree->kind != Tree::Kind::map) {
        return fault(*tree, key, expected);
    }
    enter(*tree, path_of(key.name), body);
}

void TreeReader::optional_group(const Key& key, bool& present, const std::function<void()>& body) {
    const Tree* tree = levels_.back().find(key.name);
    present = tree != nullptr && !(key.bare_flag && is_false(*tree));
    if (tree != nullptr && !present)
        levels_.back().known.push_back(key.name);
    else
        group(key, body);
}

void TreeReader::one_of(const Choice& choice) {
    Level& level = levels_.back();
    std::vector<std::size_t> present;
    for (std::size_t i = 0; i < choice.tags.size(); ++i)
        if (level.find(choice.tags[i])) present.push_back(i);
    const auto overridden = [&](std::size_t i) { return level.find(choice.tags[i])->key_place.file == override_file; };
    if (present.size() > 1) { // an override may switch to another alternative without removing the first
        std::vector<std::size_t> from_overrides;
        std::ranges::copy_if(present, std::back_inserter(from_overrides), overridden);
        if (from_overrides.size() == 1) present = from_overrides;
    }
    level.known.insert(level.known.end(), choice.tags.begin(), choice.tags.end());
    if (present.size() > 1) {
        Words found;
        for (const std::size_t i : present) found.push_back(choice.tags[i]);
        faults_.push_back(
            fault_at(level.map->place, level.path, "only one of " + join(choice.tags), join(found, " and ")));
    } else if (present.size() == 1) {
        choice.choose(present.front());
        choice.describe(present.front());
    } else if (choice.required) {
        level.missing_choice = choice.tags;
    }
}

void TreeReader::named(const Key& key, const Entries& entries) {
    const std::string expected = "a map of names" + (key.required ? std::string(", at least one") : std::string());
    const Tree* tree = take(key, expected);
    if (!tree) return;
    if (tree->kind == Tree::Kind::null || (tree->kind == Tree::Kind::map && tree->children.empty())) {
        if (key.required) fault(*tree, key, expected, "nothing");
        return;
    }
    if (tree->kind != Tree::Kind::map) return fault(*tree, key, expected);
    Words written;
    for (const Tree& child : tree->children)
        if (!child.implied) written.push_back(child.key);
    enter(*tree, path_of(key.name), [&] {
        if (entries.beside) entries.beside();
        for (const Tree& child : tree->children) {
            if (std::ranges::count(entries.reserved, child.key) > 0) continue;
            levels_.back().known.push_back(child.key);
            const Tree name{.kind = Tree::Kind::scalar, .scalar = child.key};
            const bool refers = key.names == Names::body || key.names == Names::set || key.names == Names::rigid;
            const Key entry{.name = child.key};
            if (!refers && child.implied) { // an override went inside something that the file does not have
                faults_.push_back(fault_at(child.key_place, path_of(child.key),
                                           std::string("the name of a ") + key.item + ": " + join(written),
                                           name.found(), nearest(child.key, written)));
                continue;
            }
            check_name(name, child.key_place, entry, child.key, refers ? key.names : Names::identifier);
            entries.add(child.key);
            entries.describe(entries.size() - 1);
        }
    });
}

} // namespace osculate::scene
