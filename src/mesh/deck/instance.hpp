#pragma once
/// One instance of a part, written into a deck without parts.

#include "mesh/deck/faults.hpp"
#include "mesh/deck/placement.hpp"
#include "mesh/deck/writer.hpp"

#include <algorithm>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace osculate::mesh {

/// Gives numbers and names of a part those that they have in the whole deck: number n becomes `before` + n, NAME becomes
/// INSTANCE.NAME.
class DeckInstance {
public:
    /// @param name  as first written
    DeckInstance(std::string name, const Eigen::Isometry3d& placement)
        : name_(std::move(name)), placement_(placement), moves_(placement.matrix() != Eigen::Matrix4d::Identity()) {}

    /// Takes note of what a card of the instance defines, before any card is written.
    void survey(const Deck& deck, const DeckCard& card);
    void number_from(long long before) { before_ = before; }

    /// Writes a card of the part or the instance. @param own_name  what it defines belongs to the instance; false: to the
    /// assembly, as sets do that say INSTANCE=name
    void write(const Deck& deck, const DeckCard& card, bool own_name, DeckWriter& to, DeckFaults& faults) const;
    /// A set of all elements with the name of the instance.
    void write_whole(const DeckCard& card, DeckWriter& to) const;

    /// A number or a name of the instance as it is in the whole deck.
    [[nodiscard]] std::string global(std::string_view own, const DeckPlace& place) const;

    [[nodiscard]] const std::string& name() const { return name_; }
    [[nodiscard]] long long before() const { return before_; }
    [[nodiscard]] long long largest() const { return largest_; }
    [[nodiscard]] bool has_elements() const { return has_elements_; }

private:
    [[nodiscard]] std::string range(const std::vector<std::string_view>& fields, const DeckPlace& place) const;
    [[nodiscard]] std::string node(const DeckLine& line, const std::vector<std::string_view>& fields,
                                   const DeckPlace& place) const;
    /// Two or three points, in a line of their coordinates. @param directions  from the part's origin
    [[nodiscard]] std::string points(const DeckLine& line, const std::vector<std::string_view>& fields,
                                     bool directions) const;

    std::string name_;
    Eigen::Isometry3d placement_;
    bool moves_;
    std::set<std::string> orientations_; ///< that it defines, in capitals
    long long before_ = 0, largest_ = 0; ///< largest number of its nodes and elements
    bool has_elements_ = false;
};

/// In quotes where a comma would make two fields of it.
[[nodiscard]] inline std::string as_field(std::string text) {
    return text.find(',') == std::string::npos ? text : '"' + text + '"';
}

/// Keyword without blanks, which decks write as they like.
[[nodiscard]] inline std::string keyword_of(const DeckCard& card) {
    std::string word = card.keyword;
    std::erase(word, ' ');
    return word;
}

/// Largest of the numbers of nodes and elements that a card defines or names; 0 for cards that define none.
[[nodiscard]] long long largest_number(const Deck& deck, const DeckCard& card);

} // namespace osculate::mesh
