#include "osculate/contact/facet_overlap.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

namespace osculate::contact {

namespace {

/// Overlaps smaller than this fraction of the slave facet are slivers of round-off.
constexpr double sliver = 1e-12;

double cross(const Vec2& a, const Vec2& b) {
    return a.x() * b.y() - a.y() * b.x();
}

/// A convex polygon of few corners, without an allocation.
struct Polygon {
    std::array<Vec2, 12> corner; // a quadrilateral cut by four lines has at most eight
    std::size_t count = 0;

    void add(const Vec2& x) { corner[count++] = x; }
    [[nodiscard]] const Vec2& after(std::size_t i) const { return corner[i + 1 < count ? i + 1 : 0]; }
};

double signed_area(const Polygon& polygon) {
    double twice = 0;
    for (std::size_t i = 0; i < polygon.count; ++i) twice += cross(polygon.corner[i], polygon.after(i));
    return twice / 2;
}

/// The part of a polygon to the left of every side of a convex one, counter-clockwise both (Sutherland and Hodgman 1974).
Polygon clip(Polygon subject, std::span<const Vec2> window) {
    for (std::size_t i = 0; i < window.size() && subject.count > 0; ++i) {
        const Vec2 &from = window[i], along = window[(i + 1) % window.size()] - from;
        Polygon kept;
        for (std::size_t k = 0; k < subject.count; ++k) {
            const Vec2 &a = subject.corner[k], &b = subject.after(k);
            const double left_a = cross(along, a - from), left_b = cross(along, b - from);
            if (left_a >= 0) kept.add(a);
            if ((left_a < 0) != (left_b < 0)) kept.add(a + left_a / (left_a - left_b) * (b - a));
        }
        subject = kept;
    }
    return subject;
}

/// Whether the smallest boxes around two polygons are apart.
bool apart(std::span<const Vec2> a, std::span<const Vec2> b) {
    for (int k = 0; k < 2; ++k) {
        const auto less = [k](const Vec2& x, const Vec2& y) { return x(k) < y(k); };
        const auto [low_a, high_a] = std::minmax_element(a.begin(), a.end(), less);
        const auto [low_b, high_b] = std::minmax_element(b.begin(), b.end(), less);
        if ((*high_a)(k) < (*low_b)(k) || (*high_b)(k) < (*low_a)(k)) return true;
    }
    return false;
}

/// Natural coordinates on a plane facet.
class NaturalCoordinates {
public:
    explicit NaturalCoordinates(std::span<const Vec2> corners) {
        if (corners.size() == 3) {
            centre_ = corners[0];
            a_ = corners[1] - corners[0];
            b_ = corners[2] - corners[0];
            c_.setZero();
        } else {
            centre_ = (corners[0] + corners[1] + corners[2] + corners[3]) / 4;
            a_ = (corners[1] - corners[0] + corners[2] - corners[3]) / 4;
            b_ = (corners[3] - corners[0] + corners[2] - corners[1]) / 4;
            c_ = (corners[0] - corners[1] + corners[2] - corners[3]) / 4;
        }
    }

    /// Of x = centre + a u_1 + b u_2 + c u_1 u_2; no value if the iteration fails.
    [[nodiscard]] std::optional<Vec2> operator()(const Vec2& x) const {
        Vec2 u = Vec2::Zero();
        const Vec2 from_centre = x - centre_;
        constexpr int most_iterations = 30;
        constexpr double nearly = 1e-9, far = 10; // they are of the order of one
        for (int iteration = 0; iteration < most_iterations; ++iteration) {
            const Vec2 by_u = a_ + c_ * u.y(), by_v = b_ + c_ * u.x();
            const Vec2 miss = from_centre - a_ * u.x() - by_v * u.y();
            const Vec2 step = Vec2(cross(miss, by_v), cross(by_u, miss)) / cross(by_u, by_v);
            const double length = step.lpNorm<Eigen::Infinity>();
            if (!(length < far)) return std::nullopt;
            u += step;
            if (length <= nearly || c_.isZero(0)) return u; // convergence is quadratic
        }
        return std::nullopt;
    }

private:
    Vec2 centre_, a_, b_, c_;
};

struct TrianglePoint {
    double a, b, c, weight;
};
// Shape functions on quadrilaterals that are no parallelograms are not polynomials of the place: they have terms of
// degree 5 with the first power of the unevenness, of degree 6 with its square and so on.

/// Degree 8 with 16 points (Dunavant 1985).
constexpr double a8 = 0.08141482341455420, b8 = 0.65886138449648000, c8 = 0.89890554336593800;
constexpr double u8 = 0.26311282963463800, v8 = 0.72849239295540400, w8 = 1 - u8 - v8;
constexpr double wa8 = 0.09509163426728500, wb8 = 0.10321737053471800, wc8 = 0.03245849762319800,
                 ww8 = 0.02723031417443500, centre8 = 1 - 3 * (wa8 + wb8 + wc8) - 6 * ww8;
constexpr double third = 1.0 / 3;
constexpr TrianglePoint degree_8[] = {{third, third, 1 - 2 * third, centre8},
                                      {a8, (1 - a8) / 2, (1 - a8) / 2, wa8},
                                      {(1 - a8) / 2, a8, (1 - a8) / 2, wa8},
                                      {(1 - a8) / 2, (1 - a8) / 2, a8, wa8},
                                      {b8, (1 - b8) / 2, (1 - b8) / 2, wb8},
                                      {(1 - b8) / 2, b8, (1 - b8) / 2, wb8},
                                      {(1 - b8) / 2, (1 - b8) / 2, b8, wb8},
                                      {c8, (1 - c8) / 2, (1 - c8) / 2, wc8},
                                      {(1 - c8) / 2, c8, (1 - c8) / 2, wc8},
                                      {(1 - c8) / 2, (1 - c8) / 2, c8, wc8},
                                      {u8, v8, w8, ww8},
                                      {v8, u8, w8, ww8},
                                      {u8, w8, v8, ww8},
                                      {w8, u8, v8, ww8},
                                      {v8, w8, u8, ww8},
                                      {w8, v8, u8, ww8}};

/// Degree 5 with seven points (Radon 1948).
constexpr double root_15 = 3.87298334620741688518;
constexpr double a5 = (6 - root_15) / 21, b5 = (6 + root_15) / 21;
constexpr double wa5 = (155 - root_15) / 1200, wb5 = (155 + root_15) / 1200;
constexpr TrianglePoint degree_5[] = {{third, third, 1 - 2 * third, 9.0 / 40},
                                      {a5, a5, 1 - 2 * a5, wa5},
                                      {a5, 1 - 2 * a5, a5, wa5},
                                      {1 - 2 * a5, a5, a5, wa5},
                                      {b5, b5, 1 - 2 * b5, wb5},
                                      {b5, 1 - 2 * b5, b5, wb5},
                                      {1 - 2 * b5, b5, b5, wb5}};

/// How far a quadrilateral is from a parallelogram: 0 for these and for triangles.
double unevenness(std::span<const Vec2> corners) {
    if (corners.size() == 3) return 0;
    const Vec2 off = corners[0] - corners[1] + corners[2] - corners[3];
    return off.norm() / ((corners[2] - corners[0]).norm() + (corners[3] - corners[1]).norm());
}

/// Degree 4 with six points (Dunavant 1985).
constexpr double p = 0.44594849091596488632, q = 0.09157621350977074346;
constexpr double wp = 0.22338158967801146570, wq = 0.10995174365532186764;
constexpr TrianglePoint degree_4[] = {{p, p, 1 - 2 * p, wp}, {p, 1 - 2 * p, p, wp}, {1 - 2 * p, p, p, wp},
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
    std::array<Vec2, 4> image;
    for (std::size_t i = 0; i < master.size(); ++i) image[i] = (*this)(master[i]);
    const std::span<const Vec2> facet(image.data(), master.size());
    if (apart(facet, polygon_)) return {};
    Polygon facing; // seen from the slave a master facet runs clockwise
    for (std::size_t i = facet.size(); i-- > 0;) facing.add(facet[i]);
    if (!(signed_area(facing) > sliver * area_)) return {};
    const Polygon polygon = clip(facing, polygon_);
    const double size = polygon.count < 3 ? 0 : signed_area(polygon);
    if (!(size > sliver * area_)) return {};

    Vec2 middle = Vec2::Zero();
    for (std::size_t i = 0; i < polygon.count; ++i) middle += polygon.corner[i] / static_cast<double>(polygon.count);
    // the weights have less than 1e-7 of what the rule misses
    const double uneven = std::max(unevenness(facet), unevenness(polygon_));
    const std::span<const TrianglePoint> rule = uneven < 1e-6   ? std::span<const TrianglePoint>(degree_4)
                                                : uneven < 1e-2 ? std::span<const TrianglePoint>(degree_5)
                                                                : std::span<const TrianglePoint>(degree_8);
    std::vector<OverlapPoint> points;
    points.reserve(rule.size() * polygon.count);
    const NaturalCoordinates on_slave(polygon_), on_master(facet);
    const auto integrate = [&](const Vec2& a, const Vec2& b, const Vec2& c) {
        const double area = cross(b - a, c - a) / 2;
        for (const TrianglePoint& t : rule) {
            const Vec2 x = t.a * a + t.b * b + t.c * c;
            const auto xi = on_slave(x), u = on_master(x);
            if (xi && u) points.push_back({*xi, *u, t.weight * area});
        }
    };
    if (polygon.count == 3)
        integrate(polygon.corner[0], polygon.corner[1], polygon.corner[2]);
    else
        for (std::size_t i = 0; i < polygon.count; ++i) integrate(middle, polygon.corner[i], polygon.after(i));
    return points;
}

std::vector<EdgePoint> SlavePlane::edge_over(const Vec3& from, const Vec3& to) const {
    const Vec2 a = (*this)(from), along = (*this)(to)-a;
    double first = 0, last = 1;
    for (std::size_t i = 0; i < polygon_.size(); ++i) {
        const Vec2 side = polygon_[(i + 1) % polygon_.size()] - polygon_[i];
        const double start = cross(side, a - polygon_[i]), rate = cross(side, along); // inside: start + s rate >= 0
        if (rate > 0)
            first = std::max(first, -start / rate);
        else if (rate < 0)
            last = std::min(last, -start / rate);
        else if (start < 0)
            return {};
    }
    if (!(first < last)) return {};
    constexpr std::array<std::array<double, 2>, 4> gauss{{{-0.86113631159405258, 0.34785484513745386},
                                                          {-0.33998104358485626, 0.65214515486254614},
                                                          {0.33998104358485626, 0.65214515486254614},
                                                          {0.86113631159405258, 0.34785484513745386}}};
    const NaturalCoordinates on_slave(polygon_);
    std::vector<EdgePoint> points;
    for (const auto& [at, weight] : gauss) {
        const double s = first + (1 + at) / 2 * (last - first);
        if (const auto xi = on_slave(a + s * along))
            points.push_back({*xi, s, weight / 2 * (last - first) * along.norm()});
    }
    return points;
}

std::optional<Vec2> natural_coordinates(std::span<const Vec2> corners, const Vec2& x) {
    return NaturalCoordinates(corners)(x);
}

} // namespace osculate::contact
