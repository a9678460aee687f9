#pragma once
/// Integrals over reference elements of any kind, exact far beyond the degree that shape functions need.

#include "osculate/fe/reference_element.hpp"

#include <vector>

namespace osculate::fe::fixtures {

/// A tensor product of five Gauss points, which have fifteen digits; collapsed onto a triangle times a line, or onto a
/// tetrahedron, where the reference element is one.
template <ReferenceElement E> std::vector<QuadraturePoint> exact_rule() {
    constexpr std::array<double, 5> x{-0.906179845938664, -0.538469310105683, 0, 0.538469310105683, 0.906179845938664};
    constexpr std::array<double, 5> w{0.236926885056189, 0.478628670499366, 0.568888888888889, 0.478628670499366,
                                      0.236926885056189};
    const bool cube = E::contains({-1, -1, -1}, 0), line = E::contains({0, 0, -1}, 0);
    std::vector<QuadraturePoint> rule;
    for (std::size_t i = 0; i < 5; ++i)
        for (std::size_t j = 0; j < 5; ++j)
            for (std::size_t k = 0; k < 5; ++k) {
                const double u = (1 + x[i]) / 2, v = (1 + x[j]) / 2, t = (1 + x[k]) / 2, weight = w[i] * w[j] * w[k];
                if (cube)
                    rule.push_back({{x[i], x[j], x[k]}, weight});
                else if (line)
                    rule.push_back({{u, v * (1 - u), x[k]}, weight * (1 - u) / 4});
                else
                    rule.push_back({{u, v * (1 - u), t * (1 - u) * (1 - v)}, weight * (1 - u) * (1 - u) * (1 - v) / 8});
            }
    return rule;
}

} // namespace osculate::fe::fixtures
