#include "study/parametric.hpp"

#include <algorithm>
#include <cmath>

namespace osculate::study {

namespace {

/// Curvature vector of the edge from a to b: x(t) = x_a + (d - c) t + c t^2 meets n_a and n_b at right angles; the shortest c
/// that does.                                                                           [Nagata 2005, eq (6)]
/// Straight where the normals are parallel, and where they are nearly so but lean along the edge: c then grows beyond the
/// edge's own length and the patch folds, which the averaged normals of a boundary bring about.
Vec3 curvature_vector(const Vec3& d, const Vec3& n_a, const Vec3& n_b) {
    const double cosine = n_a.dot(n_b), sine2 = 1 - cosine * cosine;
    constexpr double parallel = 1e-12; // round-off of 1 - cosine^2 has no direction to give
    if (sine2 < parallel) return Vec3::Zero();
    const double a = n_a.dot(d), b = -n_b.dot(d);
    const Vec3 c = ((a - cosine * b) * n_a + (b - cosine * a) * n_b) / sine2;
    return c.norm() > d.norm() ? Vec3::Zero() : c;
}

/// A function of the natural coordinates with its derivatives.
struct Shape {
    double f, f_1, f_2, f_11, f_12, f_22;
};

Shape product(const Shape& a, const Shape& b) {
    return {a.f * b.f,
            a.f_1 * b.f + a.f * b.f_1,
            a.f_2 * b.f + a.f * b.f_2,
            a.f_11 * b.f + 2 * a.f_1 * b.f_1 + a.f * b.f_11,
            a.f_12 * b.f + a.f_1 * b.f_2 + a.f_2 * b.f_1 + a.f * b.f_12,
            a.f_22 * b.f + 2 * a.f_2 * b.f_2 + a.f * b.f_22};
}

void add(contact::PatchPoint& p, const Shape& s, const Vec3& x) {
    p.X += s.f * x;
    p.X_a.col(0) += s.f_1 * x;
    p.X_a.col(1) += s.f_2 * x;
    p.X_11 += s.f_11 * x;
    p.X_12 += s.f_12 * x;
    p.X_22 += s.f_22 * x;
}

class Nagata final : public Approximation {
public:
    explicit Nagata(const SurfaceMesh& surface) : surface_(surface), normal_(surface.x.size(), Vec3::Zero()) {
        for (Index f = 0; f < surface.topology.facet_count(); ++f) {
            const auto v = surface.topology.facet_vertices(f);
            const std::size_t n = v.size();
            for (std::size_t c = 0; c < n; ++c) {
                const Vec3& here = surface.x[v[c]];
                const Vec3 a = (surface.x[v[(c + 1) % n]] - here).normalized();
                const Vec3 b = (surface.x[v[(c + n - 1) % n]] - here).normalized();
                normal_[v[c]] += std::acos(std::clamp(a.dot(b), -1.0, 1.0)) * a.cross(b).normalized();
            }
        }
        for (Vec3& n : normal_) n.normalize();
    }

    std::optional<SurfacePoint> at(Index facet, const Vec2& u) const override {
        const auto v = surface_.topology.facet_vertices(facet);
        const std::size_t n = v.size();
        contact::PatchPoint p;
        std::array<Shape, 4> edge{};
        if (n == 3) {
            const std::array<Shape, 3> L{
                {{1 - u.x() - u.y(), -1, -1, 0, 0, 0}, {u.x(), 1, 0, 0, 0, 0}, {u.y(), 0, 1, 0, 0, 0}}};
            for (std::size_t c = 0; c < 3; ++c) {
                add(p, L[c], surface_.x[v[c]]);
                edge[c] = product(L[c], L[(c + 1) % 3]);
            }
        } else {
            const Shape left{(1 - u.x()) / 2, -0.5, 0, 0, 0, 0}, right{(1 + u.x()) / 2, 0.5, 0, 0, 0, 0};
            const Shape low{(1 - u.y()) / 2, 0, -0.5, 0, 0, 0}, high{(1 + u.y()) / 2, 0, 0.5, 0, 0, 0};
            const Shape across = product(left, right), along = product(low, high);
            add(p, product(left, low), surface_.x[v[0]]);
            add(p, product(right, low), surface_.x[v[1]]);
            add(p, product(right, high), surface_.x[v[2]]);
            add(p, product(left, high), surface_.x[v[3]]);
            edge = {product(across, low), product(along, right), product(across, high), product(along, left)};
        }
        for (std::size_t c = 0; c < n; ++c) {
            const Index a = v[c], b = v[(c + 1) % n];
            add(p, edge[c], -curvature_vector(surface_.x[b] - surface_.x[a], normal_[a], normal_[b]));
        }
        return surface_point(p);
    }

private:
    const SurfaceMesh& surface_;
    std::vector<Vec3> normal_; ///< of each vertex
};

} // namespace

std::unique_ptr<Approximation> make_nagata(const SurfaceMesh& surface) {
    return std::make_unique<Nagata>(surface);
}

} // namespace osculate::study
