#pragma once
/// What the readers of the parts of one deck share.

#include "mesh/deck/faults.hpp"
#include "osculate/mesh/deck.hpp"

namespace osculate::mesh {

struct DeckReading {
    static constexpr std::size_t most_generated = 50'000'000;

    const Deck& deck;
    DeckFaults faults{};
    std::size_t generated = 0; ///< members that ranges, sets of sets and surfaces add up to
    bool refused = false;      ///< elements of another type: what refers to them is no other fault

    /// @param at  card or line
    template <class At> void fault(const At& at, const std::string& what) { faults.add(deck.place(at), what); }

    /// Counts so many members more; false where they are too many: a short deck must not fill the memory.
    [[nodiscard]] bool generate(std::size_t members) { return (generated += members) <= most_generated; }
};

} // namespace osculate::mesh
