#include "osculate/contact/surface_distance.hpp"

#include "contact/area_vector.hpp"
#include "contact/box_tree.hpp"
#include "osculate/mesh/triangle.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>
#include <numbers>

namespace osculate::contact {

namespace {
using mesh::Triangle;

/// What facets of a smooth surface turn by at most.
constexpr double sharp = 40 * std::numbers::pi / 180;

/// Calls visit(triangle) for a triangle, or for the four of both diagonals of a quadrilateral.
template <class Corner, class Visit> void for_triangles(std::size_t corners, const Corner& x, const Visit& visit) {
    visit(Triangle{x(0), x(1), x(2)});
    if (corners < 4) return;
    visit(Triangle{x(0), x(2), x(3)});
    visit(Triangle{x(0), x(1), x(3)});
    visit(Triangle{x(1), x(2), x(3)});
}

/// Point of the segment from a to b that is closest to p.
Vec3 closest_on_segment(const Vec3& a, const Vec3& b, const Vec3& p) {
    const Vec3 along = b - a;
    const double square = along.squaredNorm();
    return square > 0 ? Vec3(a + std::clamp(along.dot(p - a) / square, 0.0, 1.0) * along) : a;
}

/// Whether the segment p q goes through a triangle.
bool pierces(const Vec3& p, const Vec3& q, const Triangle& triangle) {
    const Vec3 n = triangle.normal();
    const double dp = n.dot(p - triangle.a), dq = n.dot(q - triangle.a);
    return (dp > 0) != (dq > 0) && triangle.holds(p + dp / (dp - dq) * (q - p));
}

double between(const Triangle& one, const Triangle& other) {
    const Vec3 p[] = {one.a, one.b, one.c}, q[] = {other.a, other.b, other.c};
    double least = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
        const Vec3 &p_next = p[(i + 1) % 3], &q_next = q[(i + 1) % 3];
        if (pierces(p[i], p_next, other) || pierces(q[i], q_next, one)) return 0;
        least = std::min({least, (p[i] - other.closest(p[i])).norm(), (q[i] - one.closest(q[i])).norm()});
        for (int k = 0; k < 3; ++k) least = std::min(least, segment_distance(p[i], p_next, q[k], q[(k + 1) % 3]));
    }
    return least;
}

Box box_of(const Vec3& low, const Vec3& high) {
    return {to_point(low), to_point(high)};
}
} // namespace

double segment_distance(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b) {
    const Vec3 u = q - p, v = b - a, w = p - a;
    const double uu = u.dot(u), uv = u.dot(v), vv = v.dot(v), det = uu * vv - uv * uv;
    double least = std::min({(p - closest_on_segment(a, b, p)).norm(), (q - closest_on_segment(a, b, q)).norm(),
                             (a - closest_on_segment(p, q, a)).norm(), (b - closest_on_segment(p, q, b)).norm()});
    if (!(det > 0)) return least;
    const double s = (uv * v.dot(w) - vv * u.dot(w)) / det, t = (uu * v.dot(w) - uv * u.dot(w)) / det;
    if (s >= 0 && s <= 1 && t >= 0 && t <= 1) least = std::min(least, (w + s * u - t * v).norm());
    return least;
}

struct SurfaceDistance::Tree {
    bgi::rtree<Leaf, bgi::rstar<16>> boxes;
};

SurfaceDistance::SurfaceDistance(const mesh::HalfEdgeSurface& surface, const std::vector<Vec3>& x)
    : surface_(surface), x_(x) {}

SurfaceDistance::~SurfaceDistance() = default;

const SurfaceDistance::Tree& SurfaceDistance::tree() const {
    if (tree_) return *tree_;
    std::vector<Leaf> leaves;
    leaves.reserve(static_cast<std::size_t>(surface_.facet_count()));
    for (Index f = 0; f < surface_.facet_count(); ++f) {
        const auto v = surface_.facet_vertices(f);
        Vec3 low = x_[v[0]], high = low;
        for (const Index i : v) {
            low = low.cwiseMin(x_[i]);
            high = high.cwiseMax(x_[i]);
        }
        leaves.emplace_back(box_of(low, high), f);
    }
    auto made = std::make_unique<Tree>();
    made->boxes = decltype(made->boxes)(leaves.begin(), leaves.end());
    tree_ = std::move(made);
    return *tree_;
}

double SurfaceDistance::from(Index facet, const Vec3& p) const {
    const auto v = surface_.facet_vertices(facet);
    double least = std::numeric_limits<double>::infinity();
    for_triangles(
        v.size(), [&](std::size_t c) -> const Vec3& { return x_[v[c]]; },
        [&](const Triangle& triangle) { least = std::min(least, (p - triangle.closest(p)).norm()); });
    return least;
}

NearFacet SurfaceDistance::closest(const Vec3& p, const Choice& counts) const {
    const auto& boxes = tree().boxes;
    const Point at = to_point(p);
    const auto every = static_cast<unsigned>(surface_.facet_count());
    std::vector<Leaf> nearest;
    NearFacet found;
    for (unsigned k = 8;; k *= 2) {
        nearest.clear();
        boxes.query(bgi::nearest(at, std::min(k, every)), std::back_inserter(nearest));
        double reached = 0;
        Vec3 foot = p;
        found = {};
        for (const auto& [box, facet] : nearest) {
            const double away = bg::distance(at, box);
            reached = std::max(reached, away);
            if (away > found.distance || (counts && !counts(facet))) continue;
            const auto v = surface_.facet_vertices(facet);
            for_triangles(
                v.size(), [&](std::size_t c) -> const Vec3& { return x_[v[c]]; },
                [&](const Triangle& triangle) {
                    const Vec3 c = triangle.closest(p);
                    const double distance = (p - c).norm();
                    if (!(distance < found.distance)) return;
                    found.facet = facet;
                    found.distance = distance;
                    foot = c;
                });
        }
        if (k < every && !(reached > found.distance)) continue;
        if (found.facet >= 0) found.at_end = is_at_end(found.facet, foot);
        return found;
    }
}

bool SurfaceDistance::is_at_end(Index facet, const Vec3& foot) const {
    constexpr double near = 1e-6; // of the facet
    const double tie = near * surface_.facet_size(facet);
    for (const Index vertex : surface_.facet_vertices(facet))
        for (const Index g : surface_.vertex_facets(vertex)) {
            const auto v = surface_.facet_vertices(g);
            for (std::size_t c = 0; c < v.size(); ++c) {
                const Index edge = surface_.first_half_edge(g) + static_cast<Index>(c);
                if (!surface_.is_boundary_edge(edge) && !surface_.is_feature_edge(edge)) continue;
                if ((foot - closest_on_segment(x_[v[c]], x_[v[(c + 1) % v.size()]], foot)).norm() <= tie) return true;
            }
        }
    return false;
}

double SurfaceDistance::from(std::span<const Vec3> corners, double most, const Choice& counts) const {
    Vec3 low = corners[0], high = low;
    for (const Vec3& corner : corners) {
        low = low.cwiseMin(corner);
        high = high.cwiseMax(corner);
    }
    const Vec3 around = Vec3::Constant(most);
    std::vector<Leaf> near;
    tree().boxes.query(bgi::intersects(box_of(low - around, high + around)), std::back_inserter(near));
    double least = most;
    for (const Leaf& leaf : near) {
        const Index facet = leaf.second;
        if (counts && !counts(facet)) continue;
        const auto v = surface_.facet_vertices(facet);
        for_triangles(
            corners.size(), [&](std::size_t c) -> const Vec3& { return corners[c]; },
            [&](const Triangle& own) {
                for_triangles(
                    v.size(), [&](std::size_t c) -> const Vec3& { return x_[v[c]]; },
                    [&](const Triangle& other) { least = std::min(least, between(own, other)); });
            });
    }
    return least;
}

double SurfaceDistance::curvature(Index facet) const {
    const Vec3 n = area_vector(surface_.facet_vertices(facet), x_);
    double largest = 0;
    for (const Index other : surface_.edge_neighbours(facet)) {
        if (other < 0) continue;
        const Vec3 m = area_vector(surface_.facet_vertices(other), x_);
        const double turn = std::atan2(n.cross(m).norm(), n.dot(m));
        if (turn <= sharp)
            largest = std::max(largest, 2 * turn / (surface_.facet_size(facet) + surface_.facet_size(other)));
    }
    return largest;
}

double SurfaceDistance::warp(Index facet) const {
    const auto v = surface_.facet_vertices(facet);
    return v.size() < 4 ? 0 : 0.25 * (x_[v[0]] - x_[v[1]] + x_[v[2]] - x_[v[3]]).norm();
}

} // namespace osculate::contact
