#pragma once
/// Rigid bodies of a deck, and what holds, moves and loads their reference nodes.

#include "deck/card_reader.hpp"

#include <vector>

namespace osculate::deck {

class RigidCards : CardReader {
public:
    /// Reads all *RIGID BODY and couplings of the deck: other cards may stand before them.
    RigidCards(const mesh::Deck& deck, DeckModel& model);

    /// Takes reference nodes out of the points of what is held, along components from 1 to 6.
    void hold(DeckValues& values, const std::vector<int>& components, DeckStep* step);
    /// The same of a force or moment.
    void load(DeckValues& values, int component, DeckStep* step);

private:
    void read(const DeckCard& card);
    /// @param kind  the card after *COUPLING
    void couple(const DeckCard& card, const DeckCard* kind);
    void couple_kinematically(const DeckCard& card);
    /// Whether lines of components have those from 1 to `count`. @param first  field of a line that they begin in
    [[nodiscard]] bool has_components(const DeckCard& card, std::size_t first, long long count);
    /// Points of a node set or a surface.
    [[nodiscard]] std::vector<Index> points_on(const std::string& name);
    void add(const DeckCard& card, DeckRigid rigid, const std::string* reference);
    template <class Add> void take_out(DeckValues& values, const Add& add);
};

} // namespace osculate::deck
