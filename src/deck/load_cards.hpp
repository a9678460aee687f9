#pragma once
/// What holds, moves, loads and heats the nodes of a deck, and the courses of these.

#include "deck/card_reader.hpp"
#include "deck/rigid_cards.hpp"

#include <string>
#include <vector>

namespace osculate::deck {

class LoadCards : CardReader {
public:
    LoadCards(const mesh::Deck& deck, DeckModel& model) : CardReader(deck, model), rigid_(deck, model) {}
    /// False: the card is none of these. @param word  its keyword without blanks  @param step  that it stands in, or null
    bool take(const DeckCard& card, const std::string& word, DeckStep* step);

private:
    void temperatures(const DeckCard& card, std::vector<DeckTemperature>& list);
    void amplitude(const DeckCard& card);
    /// The name of a card's amplitude, empty for none; false: it is lost.
    bool amplitude_of(const DeckCard& card, std::string& name);
    void boundary(const DeckCard& card);
    void forces(const DeckCard& card);
    void pressures(const DeckCard& card);
    void gravity(const std::string& place, const std::string& shown, const std::string& amplitude);
    void centrifugal(const std::string& place, const std::string& shown);
    /// Of the first field of a line of *DLOAD; all for an empty one.
    [[nodiscard]] std::vector<Index> loaded_cells() const;

    RigidCards rigid_;
    DeckStep* step_ = nullptr; ///< the one that the card stands in; null: before all
};

} // namespace osculate::deck
