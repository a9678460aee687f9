#pragma once
/// Named sets of a deck.

#include "mesh/deck/numbers.hpp"
#include "mesh/deck/reading.hpp"

#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace osculate::mesh {

/// Sets of nodes or of elements. Names in capitals are keys, as in DeckMesh.
class DeckSets {
public:
    /// @param parameter  that names a set: NSET or ELSET
    DeckSets(DeckReading& reading, const DeckNumbers& numbers, const char* parameter)
        : reading_(reading), numbers_(numbers), parameter_(parameter) {}

    /// *NSET or *ELSET: numbers, sets of before, or ranges (GENERATE).
    void read(const DeckCard& card);

    /// The set that a *NODE or *ELEMENT line names, of what is defined below it. Every record of so many fields begins
    /// with a number.
    void read_defined(const DeckCard& card, std::size_t fields);

    /// A set of a name, made where there is none.
    std::vector<Index>& named(const std::string& name);
    /// Members, unsorted, of a set in any case of its name; nullptr where there is none.
    [[nodiscard]] const std::vector<Index>* find(std::string_view name) const;

    [[nodiscard]] const DeckNumbers& numbers() const { return numbers_; }

    /// Gives all sets away by their names as first written, ascending and every member once.
    [[nodiscard]] std::map<std::string, std::vector<Index>> take_sets();
    [[nodiscard]] std::map<std::string, std::string> take_names() { return std::move(names_); }

private:
    /// Whether the members of one line have been added; where not, the card is given up.
    bool add_members(const DeckLine& line, std::vector<Index>& members);
    void add_range(const DeckLine& line, std::vector<Index>& members);

    DeckReading& reading_;
    const DeckNumbers& numbers_;
    const char* parameter_;
    std::map<std::string, std::vector<Index>> sets_;
    std::map<std::string, std::string> names_; ///< key -> as first written
    std::vector<std::string_view> fields_;     ///< of the line that is read
};

} // namespace osculate::mesh
