#include "mesh/deck/writer.hpp"

#include <memory>

namespace osculate::mesh {

void DeckWriter::copy(DeckCard card) {
    const std::size_t first = deck_.lines.size();
    deck_.lines.insert(deck_.lines.end(), from_.begin(card), from_.end(card));
    card.first = first;
    card.last = deck_.lines.size();
    deck_.cards.push_back(std::move(card));
}

void DeckWriter::line(const DeckLine& from, std::string_view text) {
    text_ += text;
    places_.push_back({from, text.size()});
}

void DeckWriter::end() {
    const auto stored = std::make_shared<const std::string>(std::move(text_));
    card_.first = deck_.lines.size();
    std::string_view rest = *stored;
    for (const Place& place : places_) {
        deck_.lines.push_back({rest.substr(0, place.size), place.from.line, place.from.file, place.from.source});
        rest.remove_prefix(place.size);
    }
    card_.last = deck_.lines.size();
    if (!stored->empty()) deck_.texts.push_back(stored);
    deck_.cards.push_back(std::move(card_));
    text_.clear();
    places_.clear();
}

} // namespace osculate::mesh
