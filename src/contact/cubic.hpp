#pragma once
/// When points, edges and facets that move on straight lines meet: roots of cubics in time.

#include "osculate/core/types.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <vector>

namespace osculate::contact {

/// c0 + c1 t + c2 t^2 + c3 t^3
struct Cubic {
    double c[4];

    [[nodiscard]] double operator()(double t) const { return c[0] + t * (c[1] + t * (c[2] + t * c[3])); }
    /// Ends of the pieces of [0, 1] on which it is monotone.
    [[nodiscard]] std::vector<double> pieces() const {
        std::vector<double> ends{0};
        const double a = 3 * c[3], b = 2 * c[2], discriminant = b * b - 4 * a * c[1];
        if (discriminant >= 0) {
            const double q = -0.5 * (b + std::copysign(std::sqrt(discriminant), b));
            const auto add = [&](double numerator, double denominator) { // a quotient beyond 1 may overflow
                if (std::abs(numerator) >= std::abs(denominator)) return;
                if (const double t = numerator / denominator; t > 0) ends.push_back(t);
            };
            add(q, a);
            add(c[1], q);
            std::ranges::sort(ends);
        }
        ends.push_back(1);
        return ends;
    }
    /// Where it changes sign between a and b, by bisection down to neighbouring numbers.
    [[nodiscard]] double root(double a, double b) const {
        const bool falls = (*this)(a) > 0;
        for (;;) {
            const double middle = 0.5 * (a + b);
            if (!(middle > a && middle < b)) return b;
            (((*this)(middle) > 0) == falls ? a : b) = middle;
        }
    }
};

/// (e0 + t e1) . (p0 + t p1) x (q0 + t q1)
inline Cubic triple_product(const Vec3& e0, const Vec3& e1, const Vec3& p0, const Vec3& p1, const Vec3& q0,
                            const Vec3& q1) {
    const Vec3 n0 = p0.cross(q0), n1 = p0.cross(q1) + p1.cross(q0), n2 = p1.cross(q1);
    return {{e0.dot(n0), e0.dot(n1) + e1.dot(n0), e0.dot(n2) + e1.dot(n1), e1.dot(n2)}};
}

} // namespace osculate::contact
