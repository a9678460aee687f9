#include "osculate/study/errors.hpp"

#include "osculate/contact/facet_patch.hpp"
#include "osculate/core/parallel.hpp"
#include "study/parametric.hpp"

#include <algorithm>
#include <cmath>

namespace osculate::study {

namespace {

/// Centres of points x points equal parts of the facet's natural coordinates.
std::vector<Vec2> sample_points(int corners, int points) {
    std::vector<Vec2> list;
    const double h = 1.0 / points;
    for (int j = 0; j < points; ++j)
        for (int i = 0; i < points; ++i) {
            if (corners == 4) {
                list.emplace_back(-1 + (2 * i + 1) * h, -1 + (2 * j + 1) * h);
                continue;
            }
            // two triangles a cell, the upper one only below the diagonal
            if (i + j < points) list.emplace_back((i + 1.0 / 3) * h, (j + 1.0 / 3) * h);
            if (i + j < points - 1) list.emplace_back((i + 2.0 / 3) * h, (j + 2.0 / 3) * h);
        }
    return list;
}

/// Angle between unit vectors; acos would lose half of the digits near 0.
double angle(const Vec3& a, const Vec3& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

struct Sums {
    double area = 0;
    Errors errors; ///< `mean` holds the integral
};

void add(ErrorMeasure& measure, double error, double weight) {
    measure.mean += weight * error;
    measure.worst = std::max(measure.worst, error);
}

Sums measure_facet(const SurfaceMesh& surface, const Approximation& approximation, const ExactSurface& exact,
                   Index facet, int points) {
    const contact::MatrixX3 corners = corners_of(surface, facet);
    const int count = static_cast<int>(corners.rows());
    const contact::FacetPatch shape(count);
    Sums sums;
    for (const Vec2& u : sample_points(count, points)) {
        ++sums.errors.points;
        const auto found = approximation.at(facet, u);
        if (!found) {
            ++sums.errors.missing;
            continue;
        }
        const contact::PatchPoint p = shape.point(u, corners);
        const double weight = p.X_a.col(0).cross(p.X_a.col(1)).norm() * (count == 4 ? 4 : 0.5);
        const ExactPoint closest =
            std::visit([&](const auto& surface_of) { return surface_of.closest(found->point); }, exact);
        sums.area += weight;
        add(sums.errors.position, (found->point - closest.point).norm(), weight);
        add(sums.errors.normal, angle(found->normal, closest.normal), weight);
        add(sums.errors.curvature, std::abs(found->mean_curvature - closest.mean_curvature), weight);
    }
    return sums;
}

} // namespace

Errors measure_errors(const SurfaceMesh& surface, const Approximation& approximation, const ExactSurface& exact,
                      int points, int threads) {
    const Index facets = surface.topology.facet_count();
    std::vector<Sums> parts(static_cast<std::size_t>(facets));
    parallel_for(threads, facets, [&](Index begin, Index end) {
        for (Index f = begin; f < end; ++f)
            parts[static_cast<std::size_t>(f)] = measure_facet(surface, approximation, exact, f, points);
    });
    double area = 0;
    Errors all;
    for (const Sums& part : parts) {
        area += part.area;
        all.points += part.errors.points;
        all.missing += part.errors.missing;
        for (const auto kind : {&Errors::position, &Errors::normal, &Errors::curvature}) {
            (all.*kind).mean += (part.errors.*kind).mean;
            (all.*kind).worst = std::max((all.*kind).worst, (part.errors.*kind).worst);
        }
    }
    if (area > 0)
        for (const auto kind : {&Errors::position, &Errors::normal, &Errors::curvature}) (all.*kind).mean /= area;
    return all;
}

} // namespace osculate::study
