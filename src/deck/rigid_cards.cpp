#include "deck/rigid_cards.hpp"

#include <algorithm>

namespace osculate::deck {

RigidCards::RigidCards(const mesh::Deck& deck, DeckModel& model) : CardReader(deck, model) {
    for (const DeckCard& card : deck.cards)
        if (without_blanks(card.keyword) == "RIGIDBODY") read(card);
}

void RigidCards::read(const DeckCard& card) {
    const std::string *elements = given(card, "ELSET"), *reference = given(card, "REFNODE");
    for (const char* other : {"NSET", "PINNSET", "TIENSET", "ANALYTICALSURFACE", "ROTNODE", "ISOTHERMAL"})
        if (given(card, other) != nullptr)
            return lose(card, std::string(other) + " has no counterpart: only rigid elements with a REF NODE have");
    if (const std::string* at = given(card, "POSITION"); at != nullptr && in_capitals(*at) != "INPUT")
        return lose(card, "POSITION=" + *at + " has no counterpart: the reference node is where the deck has it");
    if (elements == nullptr || reference == nullptr) return lose(card, "ELSET and REF NODE are expected");
    DeckRigid rigid;
    rigid.place = deck_.place(card);
    rigid.cells = cells_of(*elements);
    rigid.elements = *elements;
    const std::vector<Index> points = points_of(*reference);
    if (rigid.cells.empty()) return lose(card, "no element set '" + *elements + "'");
    if (points.size() != 1) return lose(card, "REF NODE=" + *reference + " is not one node");
    rigid.reference = points.front();
    if (!model_.rigid_of.try_emplace(rigid.reference, model_.rigid.size()).second)
        return lose(card, "another *RIGID BODY has the same reference node");
    model_.rigid.push_back(std::move(rigid));
}

template <class Add> void RigidCards::take_out(DeckValues& values, const Add& add) {
    std::erase_if(values.points, [&](Index p) {
        const auto at = model_.rigid_of.find(p);
        if (at == model_.rigid_of.end()) return false;
        if (model_.transform_of.contains(p))
            model_.lose(values.place, "a reference node with a *TRANSFORM",
                        "rigid bodies move along the axes of the scene");
        else
            add(at->second);
        return true;
    });
}

void RigidCards::hold(DeckValues& values, const std::vector<int>& components, DeckStep* step) {
    auto& to = step != nullptr ? step->rigid_held : model_.rigid_held;
    take_out(values, [&](std::size_t rigid) {
        for (const int c : components) to.push_back({rigid, c - 1, values.value, values.amplitude, values.place});
    });
}

void RigidCards::load(DeckValues& values, int component, DeckStep* step) {
    take_out(values, [&](std::size_t rigid) {
        step->rigid_forces.push_back({rigid, component - 1, values.value, values.amplitude, values.place});
    });
}

} // namespace osculate::deck
