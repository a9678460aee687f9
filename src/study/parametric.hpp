#pragma once
/// Normal and curvature of a parametric patch.

#include "osculate/contact/surface_patch.hpp"
#include "osculate/study/approximation.hpp"

#include <Eigen/LU>

namespace osculate::study {

/// H = -1/2 a^ab b_ab, b_ab = n . X,ab
inline SurfacePoint surface_point(const contact::PatchPoint& p) {
    const Vec3 n = p.normal();
    const Mat2 metric = p.X_a.transpose() * p.X_a;
    return {p.X, n, -0.5 * (metric.inverse() * p.curvature(n)).trace()};
}

/// Positions of a facet's corners.
inline contact::MatrixX3 corners_of(const SurfaceMesh& surface, Index facet) {
    const auto vertices = surface.topology.facet_vertices(facet);
    contact::MatrixX3 x(static_cast<Index>(vertices.size()), 3);
    for (std::size_t b = 0; b < vertices.size(); ++b) x.row(static_cast<Index>(b)) = surface.x[vertices[b]].transpose();
    return x;
}

} // namespace osculate::study
