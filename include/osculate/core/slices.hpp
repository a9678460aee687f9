#pragma once
/// Vectors of which several processes have a part each.

#include "osculate/core/ranks.hpp"

#include <span>
#include <vector>

namespace osculate {

/// The unknowns, and the rows, of a system that are a process' own. Maps act on vectors of full length in which the others'
/// numbers are as they happen to be, but for those that are filled in.
class Slices {
public:
    virtual ~Slices() = default;
    [[nodiscard]] virtual Ranks& ranks() const = 0;
    /// Places of one's own, of unknowns and of rows alike.
    [[nodiscard]] virtual const std::vector<Index>& own() const = 0;
    /// Fills in what a product reads of others' unknowns in x; collective.
    virtual void fill_unknowns(double* x) = 0;
    /// Fills in what a preconditioner reads of others' rows in r; collective.
    virtual void fill_rows(double* r) = 0;
    /// Puts the slices of all processes into x; collective. @param own_values  (own)
    virtual void gather(std::span<const double> own_values, double* x) const = 0;
};

} // namespace osculate
