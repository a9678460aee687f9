#pragma once
/// Sums over vectors at nodes, always in the order of the nodes.

#include "osculate/core/types.hpp"

#include <vector>

namespace osculate {

using NodalField = std::vector<Vec3>;

inline double dot(const NodalField& a, const NodalField& b) {
    double sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i].dot(b[i]);
    return sum;
}

/// a x + b y
inline NodalField weighted(double a, const NodalField& x, double b, const NodalField& y) {
    NodalField result(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) result[i] = a * x[i] + b * y[i];
    return result;
}

} // namespace osculate
