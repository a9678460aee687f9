#include "contact/fold.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace osculate::contact {

bool folds(const mesh::HalfEdgeSurface& surface, std::span<const Index> facets, const ReferencePlane& plane,
           const std::vector<Vec3>& X) {
    static const double smallest_cosine = std::cos(80 * std::numbers::pi / 180);
    constexpr double smallest_projection = 0.05;
    const Vec3 up = plane.axes.col(0).cross(plane.axes.col(1));
    for (const Index f : facets) {
        const auto vertices = surface.facet_vertices(f);
        const std::size_t n = vertices.size();
        Vec3 area = Vec3::Zero();
        for (std::size_t b = 1; b + 1 < n; ++b)
            area += (X[vertices[b]] - X[vertices[0]]).cross(X[vertices[b + 1]] - X[vertices[0]]);
        if (area.dot(up) < std::max(smallest_cosine, smallest_projection) * area.norm()) return true;
        for (std::size_t b = 0; b < n; ++b) { // corner Jacobians in the plane
            const Vec3 here = X[vertices[b]];
            const Vec3 corner = (X[vertices[(b + 1) % n]] - here).cross(X[vertices[(b + n - 1) % n]] - here);
            if (corner.dot(up) < smallest_projection * corner.norm()) return true;
        }
    }
    return false;
}

} // namespace osculate::contact
