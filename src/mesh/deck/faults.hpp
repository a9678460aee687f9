#pragma once
/// What is wrong with a deck.

#include "osculate/mesh/deck.hpp"

#include <string>
#include <string_view>
#include <vector>

namespace osculate::mesh {

/// Faults in the order they are found; the first 20 are kept, the others counted.
class DeckFaults {
public:
    void add(const std::string& place, const std::string& what);
    /// Throws MeshError with all faults, where there are any.
    void throw_if_any();

private:
    std::vector<std::string> first_;
    std::size_t count_ = 0;
};

/// Where a fault is to be reported.
struct DeckPlace {
    const Deck& deck;
    int file = 0, line = 0;
    DeckFaults& faults;
    void fault(const std::string& what) const { faults.add(deck.place(file, line), what); }
};

/// Text of a deck for a message, cut off after 60 characters.
[[nodiscard]] std::string shown(std::string_view text);

} // namespace osculate::mesh
