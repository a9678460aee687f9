#include "osculate/core/field.hpp"

#include <algorithm>
#include <cmath>

namespace osculate {

double dot(const Field& a, const Field& b) {
    return sum_over(static_cast<Index>(a.size()), 0.0, [&](Index i) { return a[i].dot(b[i]); });
}

double norm(const Field& a) {
    return std::sqrt(sum_over(static_cast<Index>(a.size()), 0.0, [&](Index i) { return a[i].squaredNorm(); }));
}

double largest_component(const Field& a) {
    double largest = 0;
    for (const Vec3& v : a) largest = std::max(largest, v.cwiseAbs().maxCoeff());
    return largest;
}

AtNode largest_distance(const Field& a, const Field& b) {
    return largest_over(static_cast<Index>(a.size()), [&](Index i) { return (a[i] - b[i]).norm(); });
}

Field weighted(double a, const Field& x, double b, const Field& y) {
    Field result(x.size());
    for (std::size_t i = 0; i < x.size(); ++i) result[i] = a * x[i] + b * y[i];
    return result;
}

Field sum(const Field& x, const Field& y) {
    Field result = x;
    result.add(1, y);
    return result;
}

} // namespace osculate
