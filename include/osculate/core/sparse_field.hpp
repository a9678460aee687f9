#pragma once
/// A Field that is zero at most nodes.

#include "osculate/core/field.hpp"

#include <algorithm>

namespace osculate {

/// The values of a Field that are not zero, in the order of their nodes.
class SparseField {
public:
    struct Entry {
        Index node;
        Vec3 value;
    };

    SparseField() = default;
    explicit SparseField(const Field& field) {
        const auto here = [](const Vec3& value) { return (value.array() != 0).any(); }; // NaN counts
        entries_.reserve(static_cast<std::size_t>(std::ranges::count_if(field, here)));
        for (std::size_t i = 0; i < field.size(); ++i)
            if (here(field[i])) entries_.push_back({static_cast<Index>(i), field[i]});
    }

    [[nodiscard]] bool empty() const noexcept { return entries_.empty(); }
    [[nodiscard]] auto begin() const noexcept { return entries_.begin(); }
    [[nodiscard]] auto end() const noexcept { return entries_.end(); }

    /// field += a *this
    void add_to(double a, Field& field) const {
        for (const auto& [node, value] : entries_) field[static_cast<std::size_t>(node)] += a * value;
    }

    /// x + a (y - x), at `nodes` nodes
    [[nodiscard]] static Field between(const SparseField& x, const SparseField& y, double a, std::size_t nodes) {
        Field field(nodes);
        x.add_to(1, field);
        auto from = x.begin();
        for (const auto& [node, value] : y) { // before a node of x comes what y has beside it
            for (; from != x.end() && from->node < node; ++from)
                field[static_cast<std::size_t>(from->node)] -= a * from->value;
            const bool both = from != x.end() && from->node == node;
            field[static_cast<std::size_t>(node)] += a * (both ? Vec3(value - from->value) : value);
            if (both) ++from;
        }
        for (; from != x.end(); ++from) field[static_cast<std::size_t>(from->node)] -= a * from->value;
        return field;
    }

private:
    std::vector<Entry> entries_;
};

} // namespace osculate
