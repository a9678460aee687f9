#pragma once
/// Points at one place.

#include "osculate/core/types.hpp"

#include <vector>

namespace osculate::mesh {

/// Per point the first of those at its place; a point that is not `used` stays by itself.
/// @param tolerance  of the diagonal of all used points' box. O(n).
[[nodiscard]] std::vector<Index> first_at_place(const std::vector<Vec3>& points, const std::vector<char>& used,
                                                double tolerance);

} // namespace osculate::mesh
