#pragma once
/// Sorting of a handful of numbers.

#include <algorithm>

namespace osculate::mesh {

/// By insertion. In std::sort of a short array GCC 12 reports accesses out of bounds that cannot be.
template <class Iterator> void sort_few(Iterator first, Iterator last) {
    for (Iterator at = first; at != last; ++at) std::rotate(std::upper_bound(first, at, *at), at, at + 1);
}

} // namespace osculate::mesh
