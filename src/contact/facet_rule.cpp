#include "contact/facet_rule.hpp"

#include "osculate/core/dense_algebra.hpp"

#include <array>
#include <cmath>

namespace osculate::contact {

Shape shape(int corners, const Vec2& u) {
    Shape result;
    if (corners == 3) {
        result.N.head<3>() << 1 - u.x() - u.y(), u.x(), u.y();
        result.N_a.topRows<3>() << -1, -1, 1, 0, 0, 1;
        return result;
    }
    constexpr std::array<double, 4> a{-1, 1, 1, -1}, b{-1, -1, 1, 1};
    for (Index i = 0; i < 4; ++i) {
        const double along = 1 + a[i] * u.x(), across = 1 + b[i] * u.y();
        result.N(i) = along * across / 4;
        result.N_a(i, 0) = a[i] * across / 4;
        result.N_a(i, 1) = b[i] * along / 4;
    }
    return result;
}

std::vector<RulePoint> facet_rule(int corners, int n) {
    std::vector<RulePoint> rule;
    if (corners == 3) {
        const double h = 1.0 / n;
        const auto add = [&](const Vec2& a, const Vec2& b, const Vec2& c) {
            for (int k = 0; k < 3; ++k) {
                const Vec2 x = (a + b + c) / 6 + (k == 0 ? a : k == 1 ? b : c) / 2;
                rule.push_back({x, h * h / 6});
            }
        };
        for (int i = 0; i < n; ++i)
            for (int k = 0; k < n - i; ++k) {
                const Vec2 a(i * h, k * h);
                add(a, a + Vec2(h, 0), a + Vec2(0, h));
                if (i + k < n - 1) add(a + Vec2(h, h), a + Vec2(0, h), a + Vec2(h, 0));
            }
        return rule;
    }
    // Gauss points from the eigenvalues of the Jacobi matrix (Golub and Welsch 1969)
    Matrix J = Matrix::Zero(n, n);
    for (int i = 1; i < n; ++i) J(i, i - 1) = J(i - 1, i) = i / std::sqrt(4.0 * i * i - 1);
    const SymmetricEigen eigen = symmetric_eigen(J);
    for (int i = 0; i < n; ++i)
        for (int k = 0; k < n; ++k) {
            const auto w = [&](int at) { return 2 * eigen.vectors(0, at) * eigen.vectors(0, at); };
            rule.push_back({Vec2(eigen.values(i), eigen.values(k)), w(i) * w(k)});
        }
    return rule;
}

} // namespace osculate::contact
