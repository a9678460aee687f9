#pragma once
/// Derivatives by central differences, to hold written-out derivatives against.

#include "osculate/core/types.hpp"

#include <algorithm>

namespace osculate::support {

/// dF/dy (F's size x y's size) of a vector function F(y) by central differences.
template <class F> Matrix central_differences(const F& f, Vector y, double step) {
    Matrix J;
    for (Index k = 0; k < y.size(); ++k) {
        const double centre = y(k);
        y(k) = centre + step;
        const double above = y(k);
        const Vector plus = f(y);
        y(k) = centre - step;
        const double width = above - y(k); // as represented, not 2 * step
        const Vector minus = f(y);
        y(k) = centre;
        if (J.size() == 0) J.resize(plus.size(), y.size());
        J.col(k) = (plus - minus) / width;
    }
    return J;
}

/// Largest entry of a - b over the largest entry of b (over one where b is smaller than that).
template <class A, class B> double relative_difference(const A& a, const B& b) {
    return (a - b).cwiseAbs().maxCoeff() / std::max(1.0, b.cwiseAbs().maxCoeff());
}

} // namespace osculate::support
