#pragma once
/// Contact of all surfaces of a deck: *CONTACT and what belongs to it.

#include "deck/bodies.hpp"
#include "deck/card_reader.hpp"

#include <string>

namespace osculate::deck {

class GeneralContactCards : CardReader {
public:
    using CardReader::CardReader;

    /// False: the card is none of these. @param step  that it stands in, or null
    bool take(const DeckCard& card, const std::string& word, const DeckStep* step);

private:
    void inclusions(const DeckCard& card);
    void add_lines(const DeckCard& card, std::vector<DeckGeneralContact::Sides>& to);
};

/// Pairs of surfaces that general contact names become pairs of the model, with their laws. Once, when all cards are read.
void add_pairs_of_general_contact(DeckModel& model);

/// The entry `general` of `contact`; empty where not all surfaces meet. Adds to what the model leaves out.
[[nodiscard]] std::string write_general_contact(DeckModel& model, const std::vector<DeckBody>& bodies);

} // namespace osculate::deck
