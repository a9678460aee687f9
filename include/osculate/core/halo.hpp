#pragma once
/// Numbers of a vector that other processes own and this one reads.

#include "osculate/core/ranks.hpp"

#include <vector>

namespace osculate {

/// Who sends what is agreed upon once; then each fill() is a message to and from each neighbour.
class Halo {
public:
    /// @param wanted  (ranks) places in a vector of the numbers that each owns and this one reads; collective
    Halo(Ranks& ranks, std::vector<std::vector<Index>> wanted);
    /// Takes these numbers of x from their owners, who have theirs; collective.
    void fill(double* x);

private:
    Ranks* ranks_;
    std::vector<std::vector<Index>> wanted_, sent_; ///< (ranks) places
    std::vector<std::vector<double>> out_, in_;     ///< scratch
};

} // namespace osculate
