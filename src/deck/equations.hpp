#pragma once
/// Linear equations between displacements: cards of a deck, and what a scene says for them.

#include "deck/bodies.hpp"
#include "deck/card_reader.hpp"

#include <string>

namespace osculate::deck {

/// Reads *EQUATION.
class EquationCards : CardReader {
public:
    using CardReader::CardReader;

    /// False for other cards.
    bool take(const DeckCard& card, const std::string& word, bool in_step);

private:
    struct Term {
        std::vector<Index> points;
        int component = 0;
        double factor = 0;
    };
    /// Terms of lines until there are as many as wanted. False: not understood.
    bool terms_of(const DeckCard& card, std::size_t& line, std::size_t wanted, std::vector<Term>& terms);
    void add(const std::string& place, const std::vector<Term>& terms);
};

/// The entries of `equations`; equations that differ by the node of their first term alone become one with `each`.
[[nodiscard]] std::string write_equations(DeckModel& model, DeckSets& sets);

} // namespace osculate::deck
