#pragma once
/// Rigid bodies of a deck, and what holds, moves and loads their reference nodes.

#include "deck/card_reader.hpp"

#include <vector>

namespace osculate::deck {

class RigidCards : CardReader {
public:
    /// Reads all *RIGID BODY of the deck: other cards may stand before them.
    RigidCards(const mesh::Deck& deck, DeckModel& model);

    /// Takes reference nodes out of the points of what is held, along components from 1 to 6.
    void hold(DeckValues& values, const std::vector<int>& components, DeckStep* step);
    /// The same of a force or moment.
    void load(DeckValues& values, int component, DeckStep* step);

private:
    void read(const DeckCard& card);
    template <class Add> void take_out(DeckValues& values, const Add& add);
};

} // namespace osculate::deck
