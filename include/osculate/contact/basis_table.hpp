#pragma once
/// Basis functions of one patch at one point, as its sums read them.

#include "osculate/core/types.hpp"

#include <vector>

namespace osculate::contact {

/// One row per derivative by natural coordinates, in this order: f; f,1 f,2; f,11 f,12 f,22; f,111 f,112 f,122 f,222. Entry k
/// of a row is for basis function k: the radial functions, then the polynomials, then numbers that mean nothing. A table that is
/// used again allocates nothing.
struct BasisTable {
    /// Rows up to a derivative.
    static constexpr int first = 3, second = 6, third = 10;

    Index width = 0; ///< of a row
    int rows = 0;
    std::vector<double> entries;

    [[nodiscard]] double* row(int r) { return entries.data() + static_cast<std::ptrdiff_t>(r) * width; }
    [[nodiscard]] const double* row(int r) const { return entries.data() + static_cast<std::ptrdiff_t>(r) * width; }
};

} // namespace osculate::contact
