#pragma once
/// Lists of numbers as sets.

#include "osculate/core/types.hpp"

#include <algorithm>
#include <vector>

namespace osculate::mesh {

/// Ascending, every number once.
inline void sort_unique(std::vector<Index>& values) {
    std::sort(values.begin(), values.end());
    values.erase(std::unique(values.begin(), values.end()), values.end());
}

} // namespace osculate::mesh
