#pragma once
/// From the numbers of a deck's nodes or elements to ours.

#include "mesh/deck/reading.hpp"
#include "osculate/core/types.hpp"

#include <string>
#include <utility>
#include <vector>

namespace osculate::mesh {

/// The deck's numbers in front of ours, ascending, as in DeckMesh.
using DeckOrder = std::vector<std::pair<long long, Index>>;

/// First of a number or a higher one.
[[nodiscard]] DeckOrder::const_iterator first_from(const DeckOrder& order, long long id);
/// Ours, -1 where there is none.
[[nodiscard]] Index find_id(const DeckOrder& order, long long id);

class DeckNumbers {
public:
    static constexpr long long largest = 2'000'000'000;

    /// @param word  "node" or "element", for messages
    explicit DeckNumbers(std::string word) : word_(std::move(word)) {}

    void add(long long id, Index number) { order_.emplace_back(id, number); }

    /// Sorts by number, so that a number that comes twice shows; and a table for numbers that are nearly without gaps.
    void index(DeckReading& reading);

    /// Ours, -1 where there is none; after index().
    [[nodiscard]] Index look_up(long long id) const {
        if (dense_.empty()) return find_id(order_, id);
        return id >= 0 && id < static_cast<long long>(dense_.size()) ? dense_[static_cast<std::size_t>(id)] : -1;
    }

    [[nodiscard]] const std::string& word() const { return word_; }
    [[nodiscard]] const DeckOrder& order() const { return order_; }
    [[nodiscard]] DeckOrder take_order() { return std::move(order_); }

private:
    std::string word_;
    DeckOrder order_;
    std::vector<Index> dense_; ///< by the deck's number; empty where gaps are many
};

} // namespace osculate::mesh
