#pragma once
/// Lists of numbers in one array.

#include "osculate/core/types.hpp"

#include <cstddef>
#include <span>
#include <vector>

namespace osculate {

/// Compressed rows without values: the neighbours of each node, for example.
struct Lists {
    Lists() = default;
    Lists(const std::vector<std::vector<Index>>& lists) { // NOLINT: the same lists, copied
        for (const std::vector<Index>& list : lists) add(list);
    }
    void add(std::span<const Index> list) {
        number.insert(number.end(), list.begin(), list.end());
        start.push_back(static_cast<Index>(number.size()));
    }
    [[nodiscard]] std::size_t size() const { return start.size() - 1; }
    [[nodiscard]] std::span<const Index> operator[](std::size_t i) const {
        return std::span(number).subspan(static_cast<std::size_t>(start[i]),
                                         static_cast<std::size_t>(start[i + 1] - start[i]));
    }

    std::vector<Index> start{0}; ///< (size + 1) into number
    std::vector<Index> number;   ///< of all lists, one after another
};

/// Lists of the places of each value, ascending.
/// @param values  each from 0 to count - 1
/// @returns       (count) places in values
template <class Values> [[nodiscard]] Lists places_of(const Values& values, std::size_t count) {
    Lists lists;
    lists.start.assign(count + 2, 0); // the last is left over
    for (const auto value : values) ++lists.start[static_cast<std::size_t>(value) + 2];
    for (std::size_t i = 2; i < lists.start.size(); ++i) lists.start[i] += lists.start[i - 1];
    lists.number.resize(values.size());
    Index place = 0;
    for (const auto value : values)
        lists.number[static_cast<std::size_t>(lists.start[static_cast<std::size_t>(value) + 1]++)] = place++;
    lists.start.pop_back();
    return lists;
}

} // namespace osculate
