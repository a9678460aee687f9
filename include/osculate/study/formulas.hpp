#pragma once
/// Closed-form solutions that studies call by name. SI throughout.

#include <span>
#include <string_view>

namespace osculate::study {

struct NamedSolution {
    const char* name;
    const char* parameters; ///< "F, R, Es"
    int count;              ///< number of parameters
    double (*value)(const double* parameters);
    const char* meaning;
    const char* source;
};

/// All solutions, by subject. Es is E* = [(1 - nu1^2)/E1 + (1 - nu2^2)/E2]^-1, R is [1/R1 + 1/R2]^-1.
[[nodiscard]] std::span<const NamedSolution> formulas();

} // namespace osculate::study
