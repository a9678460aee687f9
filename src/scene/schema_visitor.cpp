#include "scene/schema_visitor.hpp"

#include "scene/article.hpp"
#include "scene/quantity_pattern.hpp"
#include "scene/tree.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <utility>

namespace osculate::scene {

namespace {

constexpr const char* identifier = "^[A-Za-z0-9_][A-Za-z0-9_-]*$";

/// A number as people write it: whole ones without a point.
Json plain(double value) {
    constexpr double exact = 1e15;
    if (value == std::round(value) && std::abs(value) < exact) return static_cast<long long>(value);
    return value;
}

std::string in_words(const Json& value) {
    if (value.is_string()) return value.get<std::string>();
    if (value.is_number_float()) return number_text(value.get<double>());
    return value.dump();
}

/// Bounds of a plain number.
Json bounds(const Range& range) {
    Json schema = Json::object();
    if (std::isfinite(range.low)) schema[range.open_low ? "exclusiveMinimum" : "minimum"] = plain(range.low);
    if (std::isfinite(range.high)) schema[range.open_high ? "exclusiveMaximum" : "maximum"] = plain(range.high);
    return schema;
}

std::string in_words(const Key& key) {
    std::string text = key.unit == dimension::none ? "number" : name_of(key.unit) + " in " + unit_of(key.unit);
    if (const std::string range = key.range.text(); !range.empty()) text += " " + range;
    if (key.not_whole) text += ", not whole";
    return text;
}

/// A plain number, or a text with a unit; keywords for numbers and those for texts do not disturb one another.
Json quantity(const Key& key) {
    Json schema{{"type", {"number", "string"}}};
    schema.update(bounds(key.range));
    schema["pattern"] = quantity_pattern(key);
    schema["patternErrorMessage"] = "expected " + with_article(in_words(key));
    Json not_finite{{"type", "number"}, {"minimum", 1e308}}; // NaN is not below anything either
    if (key.not_whole)
        schema["not"]["anyOf"] = {not_finite, {{"type", "integer"}}};
    else
        schema["not"] = not_finite;
    return schema;
}

Json list_of(const Json& items, std::size_t count) {
    return {{"type", "array"}, {"items", items}, {"minItems", count}, {"maxItems", count}};
}

Json direction(const Key& key) {
    Json schema = list_of(quantity(key), 3);
    schema["contains"] = {{"not", {{"const", 0}}}};
    return schema;
}

/// A quantity, or a map with a table or an expression.
Json course_of(const Key& key) {
    Key time{.name = "table", .unit = dimension::time, .range = range::not_negative};
    Json schema = quantity(key);
    schema["type"] = {"number", "string", "object"};
    Json row = {{"type", "array"}, {"items", {quantity(time), quantity(key)}}, {"minItems", 2}, {"maxItems", 2}};
    Json table = {{"type", "array"},
                  {"description", "Rows [time since the stage's start, value], times ascending; linear in between."},
                  {"items", row},
                  {"minItems", 2}};
    Json unit{{"type", "string"},
              {"description", "Unit of the expression's value; " + unit_of(key.unit) + " unless given."}};
    unit["pattern"] = "^ *" + unit_pattern(key.unit) + " *$";
    unit["patternErrorMessage"] = "expected a unit of " + name_of(key.unit);
    schema["properties"] = {
        {"table", table},
        {"expression",
         {{"type", {"string", "number"}}, {"description", "Formula in t, the seconds since the stage's start."}}},
        {"unit", unit}};
    schema["additionalProperties"] = false;
    schema["dependencies"] = {{"table", {{"not", {{"required", {"expression"}}}}}}, {"unit", {"expression"}}};
    schema["anyOf"] = {{{"type", {"number", "string"}}}, {{"required", {"table"}}}, {{"required", {"expression"}}}};
    return schema;
}

/// A word as YAML reads it: one of digits is a number.
void add_word(Json& list, const std::string& word) {
    int number = 0;
    const char* end = word.data() + word.size();
    if (std::from_chars(word.data(), end, number).ptr == end) list.push_back(number);
    list.push_back(word);
}

Json any_of_words(const Words& vocabulary) {
    Json list = Json::array();
    for (const std::string& word : vocabulary) add_word(list, word);
    return {{"enum", list}};
}

constexpr const char* over_time = ", or {table: [[time, value], ...]}, or {expression: formula in t, unit: its unit}";

} // namespace

// ---- maps --------------------------------------------------------------------------------------------------------------

SchemaVisitor::Level SchemaVisitor::level_of(const std::function<void()>& body) {
    levels_.emplace_back();
    body();
    Level level = std::move(levels_.back());
    levels_.pop_back();
    return level;
}

Json SchemaVisitor::map_of(const Level& level) {
    const bool may_be_empty = level.required.empty() && !level.choice_required;
    Json schema;
    schema["type"] = may_be_empty ? Json{"object", "null"} : Json("object");
    schema["properties"] = level.properties;
    schema["additionalProperties"] = false;
    if (!level.required.empty()) schema["required"] = level.required;
    if (level.tags.empty()) return schema;
    if (level.choice_required) {
        for (const std::string& tag : level.tags) schema["oneOf"].push_back({{"required", {tag}}});
    } else {
        for (std::size_t i = 0; i < level.tags.size(); ++i)
            for (std::size_t k = i + 1; k < level.tags.size(); ++k)
                schema["not"]["anyOf"].push_back({{"type", "object"}, {"required", {level.tags[i], level.tags[k]}}});
    }
    return schema;
}

Json SchemaVisitor::document(const std::function<void()>& body) {
    return map_of(level_of(body));
}

void SchemaVisitor::add(const Key& key, Json schema, const std::string& what, const Json& value) {
    Level& level = levels_.back();
    const bool tag = level.in_choice && std::ranges::count(level.tags, key.name) > 0;
    Json property;
    std::string text = key.meaning;
    if (!what.empty()) {
        text += (text.empty() ? "" : "\n\n") + what;
        const auto first = text.size() - what.size();
        text[first] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[first])));
        if (tag)
            text += "; one of " + join(level.tags);
        else if (key.required)
            text +=
                key.instead == nullptr ? "; required" : std::string("; required unless ") + key.instead + " is given";
        else if (key.default_text)
            text += std::string("; default ") + key.default_text;
        else if (!value.is_null())
            text += "; default " + in_words(value);
        text += ".";
    }
    if (!text.empty()) property["description"] = text;
    property.update(schema);
    if (!key.required && !tag && !key.default_text && !value.is_null()) property["default"] = value;
    if (key.required && !tag && key.instead == nullptr) level.required.push_back(key.name);
    level.properties[key.name] = std::move(property);
}

void SchemaVisitor::group(const Key& key, const std::function<void()>& body) {
    const Level level = level_of(body);
    Json schema = map_of(level);
    if (key.bare_word) {
        Json word = any_of_words(level.tags);
        word["type"] = "string";
        schema = {{"anyOf", {std::move(word), std::move(schema)}}};
        add(key, schema, "one of " + join(level.tags) + ", as a word or with its keys", level.chosen);
        return;
    }
    if (key.bare_flag) schema = {{"anyOf", {Json{{"type", "boolean"}}, std::move(schema)}}};
    add(key, schema, "", nullptr);
}

void SchemaVisitor::optional_group(const Key& key, bool& /*present*/, const std::function<void()>& body) {
    group(key, body);
}

void SchemaVisitor::one_of(const Choice& choice) {
    Level& level = levels_.back();
    level.tags = choice.tags;
    level.choice_required = choice.required;
    level.chosen = choice.tags[choice.active];
    for (std::size_t i = 0; i < choice.tags.size(); ++i) {
        choice.choose(i);
        levels_.back().in_choice = true;
        choice.describe(i);
        levels_.back().in_choice = false;
    }
    choice.choose(choice.active);
}

void SchemaVisitor::named(const Key& key, const Entries& entries) {
    const std::string name = std::string("<") + key.item + ">";
    Level level = level_of([&] {
        if (entries.beside) entries.beside();
        entries.add(name);
        entries.describe(0);
    });
    Json schema;
    schema["type"] = key.required ? Json("object") : Json{"object", "null"};
    schema["additionalProperties"] = level.properties.at(name);
    for (const std::string& reserved : entries.reserved) schema["properties"][reserved] = level.properties.at(reserved);
    if (key.required) schema["minProperties"] = 1;
    schema["propertyNames"] = {{"pattern", identifier}};
    const bool refers = key.names == Names::body || key.names == Names::set || key.names == Names::rigid;
    add(key, schema,
        std::string("map of ") + (refers ? "a " : "names to a ") + key.item + (refers ? "'s name" : "") +
            (refers ? " to its value" : ""),
        nullptr);
}

// ---- single values -----------------------------------------------------------------------------------------------------

void SchemaVisitor::number(const Key& key, double& value) {
    add(key, quantity(key), in_words(key), plain(value));
}

void SchemaVisitor::optional_number(const Key& key, std::optional<double>& /*value*/) {
    add(key, quantity(key), in_words(key), nullptr);
}

void SchemaVisitor::optional_relative_length(const Key& key, std::optional<RelativeLength>& /*value*/) {
    Key length = key;
    length.unit = dimension::length;
    length.range = range::size;
    Json schema = quantity(key);
    schema["pattern"] = quantity_pattern(length);
    schema["patternErrorMessage"] = "expected " + with_article(in_words(key)) + ", or a length with its unit";
    add(key, schema, in_words(key) + ", or a length with its unit", nullptr);
}

void SchemaVisitor::vector(const Key& key, Vec3& value) {
    add(key, key.direction ? direction(key) : list_of(quantity(key), 3),
        "[x, y, z], each " + with_article(in_words(key)), Json{plain(value.x()), plain(value.y()), plain(value.z())});
}

void SchemaVisitor::optional_vector(const Key& key, std::optional<Vec3>& /*value*/) {
    add(key, list_of(quantity(key), 3), "[x, y, z], each " + with_article(in_words(key)), nullptr);
}

void SchemaVisitor::course(const Key& key, Course& value) {
    add(key, course_of(key), in_words(key) + over_time, plain(value.value()));
}

void SchemaVisitor::optional_course(const Key& key, std::optional<Course>& /*value*/) {
    add(key, course_of(key), in_words(key) + over_time, nullptr);
}

void SchemaVisitor::courses(const Key& key, std::array<Course, 3>& /*value*/) {
    add(key, list_of(course_of(key), 3), "[x, y, z], each " + with_article(in_words(key)) + over_time, nullptr);
}

void SchemaVisitor::table(const Key& key, const Key& first, Table& /*value*/) {
    Json row = {{"type", "array"}, {"items", {quantity(first), quantity(key)}}, {"minItems", 2}, {"maxItems", 2}};
    add(key, {{"type", "array"}, {"items", row}, {"minItems", 2}},
        "rows [" + first.name + " (" + unit_of(first.unit) + "), " + in_words(key) + "]", nullptr);
}

void SchemaVisitor::integer(const Key& key, int& value) {
    Json schema{{"type", "integer"}};
    schema.update(bounds(key.range));
    add(key, schema, "whole number " + key.range.text(), value);
}

void SchemaVisitor::divisions(const Key& key, std::array<int, 3>& value) {
    Json item{{"type", "integer"}};
    item.update(bounds(key.range));
    add(key, list_of(item, 3), "three whole numbers, product at most " + number_text(key.largest_product), value);
}

void SchemaVisitor::integers(const Key& key, std::vector<int>& /*value*/) {
    Json item{{"type", "integer"}};
    item.update(bounds(key.range));
    add(key, {{"type", "array"}, {"minItems", 1}, {"items", item}}, "a list of whole numbers", nullptr);
}

void SchemaVisitor::flag(const Key& key, bool& value) {
    add(key, {{"enum", {true, false, "yes", "no"}}}, "true or false", value);
}

void SchemaVisitor::text(const Key& key, std::string& value) {
    const auto what = [&]() -> std::string {
        switch (key.names) {
        case Names::body: return "name of a body";
        case Names::set: return "name of a set";
        case Names::pair: return "name of a pair";
        default: return "text";
        }
    };
    Json schema;
    schema["type"] = {"string", "number", "boolean"}; // a name of digits is a number to YAML
    if (key.names == Names::identifier) schema["pattern"] = identifier;
    if (key.required) schema["minLength"] = 1;
    add(key, schema, what(), value.empty() ? Json(nullptr) : Json(value));
}

void SchemaVisitor::two_names(const Key& key, std::array<std::string, 2>& /*value*/) {
    const Json name{{"type", {"string", "number", "boolean"}}, {"minLength", 1}};
    add(key, list_of(name, 2), "names of two sets", nullptr);
}

void SchemaVisitor::word(const Key& key, const Words& vocabulary, std::size_t& index) {
    Json all = Json::array(), chosen = Json::array();
    add_word(chosen, vocabulary[index]);
    add(key, any_of_words(vocabulary), "one of " + join(vocabulary), chosen[0]);
}

void SchemaVisitor::words(const Key& key, const Words& vocabulary, std::vector<std::string>& value) {
    Json schema{{"type", "array"}, {"items", any_of_words(vocabulary)}, {"uniqueItems", true}};
    add(key, schema, "list of " + join(vocabulary), value);
}

void SchemaVisitor::points(const Key& key, std::vector<Vec3>& /*value*/) {
    add(key, {{"type", "array"}, {"minItems", 2}, {"items", list_of(quantity(key), 3)}},
        "a list of [x, y, z], each " + with_article(in_words(key)), nullptr);
}

void SchemaVisitor::axes(const Key& key, Mat3& /*value*/) {
    Key component = key;
    component.range = range::direction;
    add(key, list_of(direction(component), 2), "two directions", nullptr);
}

} // namespace osculate::scene
