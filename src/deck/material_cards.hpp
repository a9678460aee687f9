#pragma once
/// Materials of a deck.

#include "deck/card_reader.hpp"

namespace osculate::deck {

class MaterialCards : public CardReader {
public:
    using CardReader::CardReader;
    /// False: the card is none of these. @param word  its keyword without blanks  @param in_step  whether a step has begun
    bool take(const DeckCard& card, const std::string& word, bool in_step);

private:
    void begin_material(const DeckCard& card);
    void damping(const DeckCard& card);
    void expansion(const DeckCard& card);
    void hardening(const DeckCard& card);
    void orthotropic(const DeckCard& card, bool constants, DeckMaterial& m);
    void orientation(const DeckCard& card);
    void material_data(const DeckCard& card);

    std::string material_; ///< the last one
};

} // namespace osculate::deck
