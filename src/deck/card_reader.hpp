#pragma once
/// What all readers of a deck's cards need.

#include "deck/model.hpp"

#include <algorithm>
#include <string>
#include <string_view>
#include <vector>

namespace osculate::deck {

using mesh::DeckCard;
using mesh::DeckLine;
using mesh::in_capitals;
using mesh::split_fields;
using mesh::to_integer;
using mesh::to_number;

/// Without blanks, as decks are free to write `SURFACE TO SURFACE`.
inline std::string without_blanks(std::string text) {
    std::erase_if(text, [](char c) { return c == ' ' || c == '\t'; });
    return text;
}

class CardReader {
public:
    /// Both must outlive this object.
    CardReader(const mesh::Deck& deck, DeckModel& model) : deck_(deck), model_(model) {}

protected:
    void lose(const std::string& place, const std::string& what, const std::string& why) {
        model_.lose(place, what, why);
    }
    void lose(const DeckCard& card, const std::string& why) { lose(deck_.place(card), "*" + card.keyword, why); }
    void note(const DeckCard& card, const std::string& why) { model_.note(deck_.place(card), "*" + card.keyword, why); }

    [[nodiscard]] static std::string capitals_of(const DeckCard& card, const char* name) {
        const std::string* value = card.parameter(name);
        return value == nullptr ? "" : in_capitals(*value);
    }

    /// Numbers of a data line; 0 for fields that are left empty or missing.
    std::vector<double> numbers(const DeckLine& line, std::size_t least) {
        split_fields(line.text, fields_);
        std::vector<double> values(std::max(least, fields_.size()), 0.0);
        for (std::size_t f = 0; f < fields_.size(); ++f)
            if (!fields_[f].empty() && !to_number(fields_[f], values[f]))
                lose(deck_.place(line), std::string(line.source.substr(0, 60)), "no number");
        return values;
    }

    std::vector<Index> cells_of(std::string_view name) const {
        long long id = 0;
        if (to_integer(name, id)) {
            const Index cell = model_.mesh.cell(id);
            return cell < 0 ? std::vector<Index>{} : std::vector<Index>{cell};
        }
        const auto at = model_.mesh.element_set_names.find(in_capitals(name));
        return at == model_.mesh.element_set_names.end() ? std::vector<Index>{} : model_.mesh.raw.parts.at(at->second);
    }

    std::vector<Index> points_of(std::string_view name) const {
        long long id = 0;
        if (to_integer(name, id)) {
            const Index point = model_.mesh.point(id);
            return point < 0 ? std::vector<Index>{} : std::vector<Index>{point};
        }
        const auto at = model_.mesh.node_set_names.find(in_capitals(name));
        return at == model_.mesh.node_set_names.end() ? std::vector<Index>{} : model_.mesh.raw.node_sets.at(at->second);
    }

    /// Value of a parameter whose name decks write with blanks or without. @param name  without
    static const std::string* given(const DeckCard& card, std::string_view name) {
        for (const auto& [key, value] : card.parameters)
            if (without_blanks(key) == name) return &value;
        return nullptr;
    }

    const mesh::Deck& deck_;
    DeckModel& model_;
    std::vector<std::string_view> fields_; ///< of a line
};

} // namespace osculate::deck
