#pragma once
/// A deck that is written from the lines of another one.

#include "osculate/mesh/deck.hpp"

#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace osculate::mesh {

/// Cards and lines keep the places of those that they come from.
class DeckWriter {
public:
    /// @param from  outlives this object
    explicit DeckWriter(const Deck& from) : from_(from) {
        deck_.files = from.files;
        deck_.texts = from.texts;
    }

    /// A card of the other deck as it is, its parameters changed at most.
    void copy(DeckCard card);

    /// A card whose lines follow one by one, until end().
    void begin(DeckCard card) { card_ = std::move(card); }
    void line(const DeckLine& from, std::string_view text);
    void end();

    [[nodiscard]] Deck& deck() { return deck_; }
    [[nodiscard]] Deck take() { return std::move(deck_); }

private:
    struct Place {
        DeckLine from;
        std::size_t size; ///< of the text
    };
    const Deck& from_;
    Deck deck_;
    DeckCard card_;
    std::string text_; ///< of the lines of the card
    std::vector<Place> places_;
};

} // namespace osculate::mesh
