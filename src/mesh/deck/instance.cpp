#include "mesh/deck/instance.hpp"

#include "mesh/deck/numbers.hpp"

#include <map>
#include <optional>

namespace osculate::mesh {
namespace {

/// What stands in the fields of a card's lines.
enum class Fields : char { other, nodes, numbers, members, first_member, terms, axes, directions };

Fields fields_of(const DeckCard& card) {
    static const std::map<std::string, Fields> known{
        {"NODE", Fields::nodes},     {"ELEMENT", Fields::numbers},      {"NSET", Fields::members},
        {"ELSET", Fields::members},  {"TIE", Fields::members},          {"SURFACE", Fields::first_member},
        {"EQUATION", Fields::terms}, {"TRANSFORM", Fields::directions}, {"ORIENTATION", Fields::directions}};
    const auto at = known.find(keyword_of(card));
    if (at == known.end()) return Fields::other;
    const std::string* axes = card.parameter(at->first == "TRANSFORM" ? "TYPE" : "SYSTEM");
    const std::string kind = axes == nullptr ? "" : in_capitals(*axes);
    const bool rectangular = kind.empty() || kind == "R" || kind.starts_with("RECT");
    return at->second == Fields::directions && !rectangular ? Fields::axes : at->second;
}

/// Parameters that name sets, surfaces or axes of the part.
const std::set<std::string> of_part{"NSET",    "ELSET",   "SURFACE",    "ORIENTATION",      "REFNODE",
                                    "PINNSET", "TIENSET", "ISOTHERMAL", "ANALYTICALSURFACE"};

} // namespace

long long largest_number(const Deck& deck, const DeckCard& card) {
    const std::string word = keyword_of(card);
    if (word != "NODE" && word != "ELEMENT") return 0;
    long long largest = 0;
    std::vector<std::string_view> fields;
    for (auto line = deck.begin(card); line != deck.end(card); ++line) {
        split_fields(line->text, fields);
        if (word == "NODE" && fields.size() > 1) fields.resize(1);
        for (const std::string_view field : fields)
            if (long long id = 0; to_integer(field, id) && id <= DeckNumbers::largest) largest = std::max(largest, id);
    }
    return largest;
}

void DeckInstance::survey(const Deck& deck, const DeckCard& card) {
    largest_ = std::max(largest_, largest_number(deck, card));
    has_elements_ = has_elements_ || (card.keyword == "ELEMENT" && card.first != card.last);
    if (card.keyword != "ORIENTATION") return;
    if (const std::string* name = card.parameter("NAME")) orientations_.insert(in_capitals(*name));
}

std::string DeckInstance::global(std::string_view own, const DeckPlace& place) const {
    long long id = 0;
    if (own.empty()) return "";
    if (!to_integer(own, id)) return name_ + "." + std::string(own);
    if (id <= 0) return std::string(own); // no number of a node or element
    if (id > largest_) {
        place.fault("instance '" + name_ + "' has no node or element " + std::to_string(id));
        return std::string(own);
    }
    return std::to_string(before_ + id);
}

std::string DeckInstance::range(const std::vector<std::string_view>& fields, const DeckPlace& place) const {
    std::string text;
    for (std::size_t f = 0; f < fields.size(); ++f) {
        long long id = 0;
        const bool beyond = f == 1 && to_integer(fields[f], id) && id > largest_; // those that exist are in the range
        text += (f > 0 ? ", " : "") + (beyond  ? std::to_string(before_ + largest_)
                                       : f < 2 ? global(fields[f], place)
                                               : std::string(fields[f]));
    }
    return text;
}

std::string DeckInstance::node(const DeckLine& line, const std::vector<std::string_view>& fields,
                               const DeckPlace& place) const {
    const std::string_view text = line.text;
    const std::size_t comma = text.find(',');
    Vec3 x;
    if (comma == std::string_view::npos || fields.empty()) return std::string(text);
    const std::string number = global(fields[0], place);
    if (!moves_ || !read_vector(std::span(fields).subspan(1), x)) return number + std::string(text.substr(comma));
    return number + ", " + written(placement_ * x);
}

std::string DeckInstance::points(const DeckLine& line, const std::vector<std::string_view>& fields,
                                 bool directions) const {
    std::string text;
    constexpr std::size_t most = 9;
    Vec3 x;
    for (std::size_t f = 0; f < fields.size() && f < most; f += 3) {
        if (!read_vector(std::span(fields).subspan(f), x)) return std::string(line.text);
        text += (text.empty() ? "" : ", ") + written(directions ? Vec3(placement_.linear() * x) : Vec3(placement_ * x));
    }
    return text;
}

void DeckInstance::write(const Deck& deck, const DeckCard& card, bool own_name, DeckWriter& to,
                         DeckFaults& faults) const {
    DeckCard made = card;
    const Fields kind = fields_of(card);
    const bool named = card.keyword == "SURFACE" || card.keyword == "ORIENTATION";
    for (auto& [key, value] : made.parameters) {
        const bool defines = (named && key == "NAME") || of_part.contains(key);
        if (!own_name || !defines || value.empty()) continue;
        // axes may be those of the whole deck
        if (key == "ORIENTATION" && !orientations_.contains(in_capitals(value))) continue;
        value = global(value, {deck, card.file, card.line, faults});
    }
    if (kind == Fields::other) return to.copy(std::move(made));
    const bool generate = card.parameter("GENERATE") != nullptr;
    to.begin(std::move(made));
    std::vector<std::string_view> fields;
    for (auto line = deck.begin(card); line != deck.end(card); ++line) {
        split_fields(line->text, fields);
        const DeckPlace place{deck, line->file, line->line, faults};
        const auto all = [&](std::size_t every) {
            std::string text;
            for (std::size_t f = 0; f < fields.size(); ++f)
                text +=
                    (f > 0 ? ", " : "") + as_field(f % every == 0 ? global(fields[f], place) : std::string(fields[f]));
            return text;
        };
        const bool first = line == deck.begin(card);
        if (kind == Fields::nodes)
            to.line(*line, node(*line, fields, place));
        else if (kind == Fields::members && generate)
            to.line(*line, range(fields, place));
        else if (kind == Fields::numbers || kind == Fields::members)
            to.line(*line, all(1));
        else if (kind == Fields::first_member)
            to.line(*line, all(fields.size() + 1));
        else if (kind == Fields::terms && fields.size() > 1)
            to.line(*line, all(3));
        else if ((kind == Fields::axes || kind == Fields::directions) && first)
            to.line(*line, points(*line, fields, kind == Fields::directions));
        else
            to.line(*line, line->text);
    }
    to.end();
}

void DeckInstance::write_whole(const DeckCard& card, DeckWriter& to) const {
    DeckCard set = card;
    set.keyword = "ELSET";
    set.parameters = {{"ELSET", name_}, {"GENERATE", ""}};
    to.begin(std::move(set));
    to.line({{}, card.line, card.file, {}}, std::to_string(before_ + 1) + ", " + std::to_string(before_ + largest_));
    to.end();
}

} // namespace osculate::mesh
