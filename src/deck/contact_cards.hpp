#pragma once
/// Contact, ties and sectors of a deck, and what steps change of them.

#include "deck/card_reader.hpp"

namespace osculate::deck {

class ContactCards : public CardReader {
public:
    using CardReader::CardReader;
    /// False: the card is none of these. @param word  its keyword without blanks  @param step  that it stands in, or null
    bool take(const DeckCard& card, const std::string& word, DeckStep* step);
    void end_step() { changed_ = changed_law_ = {}; }

private:
    void friction(const DeckCard& card);
    void decaying_friction(const DeckCard& card, const std::vector<double>& v);
    void pair(const DeckCard& card);
    /// A distance that moves all slave nodes, where a set of nodes to move has them all.
    double adjust_all(const DeckCard& card, const std::string& slave, const std::string& set);
    void model_change(const DeckCard& card);
    /// The ends of a sector; how many there are says *CYCLIC SYMMETRY MODEL.
    void ring(const DeckCard& card);
    void ring_model(const DeckCard& card);
    void tie(const DeckCard& card);
    /// Contact gives way or is exact, or surfaces are tied; what keeps them together, but lets them slide, is another matter.
    void surface_behavior(const DeckCard& card);
    void damping(const DeckCard& card);
    /// The law of such a card; nothing where it has none. @param law  its name without blanks
    std::optional<DeckOverclosure> overclosure_of(const DeckCard& card, const std::string& law);

    DeckStep* step_ = nullptr;          ///< the one that the card stands in; null: before all
    std::string interaction_;           ///< the last one
    std::string changed_, changed_law_; ///< whose friction, whose overclosure the step changes
};

} // namespace osculate::deck
