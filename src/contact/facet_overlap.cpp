#include "osculate/contact/facet_overlap.hpp"

#include "osculate/contact/facet_patch.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace osculate::contact {

namespace {

/// Overlaps smaller than this fraction of the slave facet are slivers of round-off.
constexpr double sliver = 1e-12;

double cross(const Vec2& a, const Vec2& b) {
    return a.x() * b.y() - a.y() * b.x();
}

double signed_area(std::span<const Vec2> polygon) {
    double twice = 0;
    for (std::size_t i = 0; i < polygon.size(); ++i) twice += cross(polygon[i], polygon[(i + 1) % polygon.size()]);
    return twice / 2;
}

/// The part of a polygon to the left of every side of a convex one, counter-clockwise both (Sutherland and Hodgman 1974).
std::vector<Vec2> clip(std::vector<Vec2> subject, std::span<const Vec2> window) {
    std::vector<Vec2> kept;
    for (std::size_t i = 0; i < window.size() && !subject.empty(); ++i) {
        const Vec2 &from = window[i], along = window[(i + 1) % window.size()] - from;
        kept.clear();
        for (std::size_t k = 0; k < subject.size(); ++k) {
            const Vec2 &a = subject[k], &b = subject[(k + 1) % subject.size()];
            const double left_a = cross(along, a - from), left_b = cross(along, b - from);
            if (left_a >= 0) kept.push_back(a);
            if ((left_a < 0) != (left_b < 0)) kept.push_back(a + left_a / (left_a - left_b) * (b - a));
        }
        subject.swap(kept);
    }
    return subject;
}

struct TrianglePoint {
    double a, b, c, weight;
};
/// Degree 4 with six points (Dunavant 1985).
constexpr double p = 0.44594849091596488632, q = 0.09157621350977074346;
constexpr double wp = 0.22338158967801146570, wq = 0.10995174365532186764;
constexpr TrianglePoint rule[] = {{p, p, 1 - 2 * p, wp}, {p, 1 - 2 * p, p, wp}, {1 - 2 * p, p, p, wp},
                                  {q, q, 1 - 2 * q, wq}, {q, 1 - 2 * q, q, wq}, {1 - 2 * q, q, q, wq}};

} // namespace

SlavePlane::SlavePlane(std::span<const Vec3> corners) : centre_(Vec3::Zero()) {
    for (const Vec3& x : corners) centre_ += x / static_cast<double>(corners.size());
    const Vec3 vector_area = corners.size() == 4 ? Vec3((corners[2] - corners[0]).cross(corners[3] - corners[1]) / 2)
                                                 : Vec3((corners[1] - corners[0]).cross(corners[2] - corners[0]) / 2);
    area_ = vector_area.norm();
    normal_ = vector_area / area_;
    e1_ = corners[1] - corners[0];
    e1_ = (e1_ - normal_ * normal_.dot(e1_)).normalized();
    e2_ = normal_.cross(e1_);
    for (const Vec3& x : corners) polygon_.push_back((*this)(x));
}

std::vector<OverlapPoint> SlavePlane::overlap(std::span<const Vec3> master) const {
    std::vector<Vec2> facet, facing; // seen from the slave a master facet runs clockwise
    for (const Vec3& x : master) facet.push_back((*this)(x));
    facing.assign(facet.rbegin(), facet.rend());
    if (!(signed_area(facing) > sliver * area_)) return {};
    const std::vector<Vec2> polygon = clip(facing, polygon_);
    const double size = polygon.size() < 3 ? 0 : signed_area(polygon);
    if (!(size > sliver * area_)) return {};

    Vec2 middle = Vec2::Zero();
    for (const Vec2& corner : polygon) middle += corner / static_cast<double>(polygon.size());
    std::vector<OverlapPoint> points;
    const auto integrate = [&](const Vec2& a, const Vec2& b, const Vec2& c) {
        const double area = cross(b - a, c - a) / 2;
        for (const TrianglePoint& t : rule) {
            const Vec2 x = t.a * a + t.b * b + t.c * c;
            const auto xi = natural_coordinates(polygon_, x), u = natural_coordinates(facet, x);
            if (xi && u) points.push_back({*xi, *u, t.weight * area});
        }
    };
    if (polygon.size() == 3)
        integrate(polygon[0], polygon[1], polygon[2]);
    else
        for (std::size_t i = 0; i < polygon.size(); ++i)
            integrate(middle, polygon[i], polygon[(i + 1) % polygon.size()]);
    return points;
}

std::optional<Vec2> natural_coordinates(std::span<const Vec2> corners, const Vec2& x) {
    const FacetPatch patch(static_cast<int>(corners.size()));
    const auto n = static_cast<Index>(corners.size());
    Vec2 u = patch.centre();
    constexpr int most_iterations = 30;
    constexpr double tolerance = 1e-14, far = 10; // natural coordinates are of the order of one
    double last = far;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
        Vector phi(n);
        MatrixX2 phi_a(n, 2);
        patch.weights(u, phi, phi_a);
        Vec2 miss = x;
        Mat2 J = Mat2::Zero();
        for (Index i = 0; i < n; ++i) {
            miss -= phi(i) * corners[static_cast<std::size_t>(i)];
            J += corners[static_cast<std::size_t>(i)] * phi_a.row(i);
        }
        const Vec2 step = J.inverse() * miss;
        const double length = step.norm();
        if (!(length < far)) return std::nullopt;
        u += step;
        if (length <= tolerance || (length < 1e-10 && length >= last / 2)) return u; // at rest, or at round-off
        last = length;
    }
    return std::nullopt;
}

} // namespace osculate::contact
