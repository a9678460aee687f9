#pragma once
/// Distance of an approximation from the exact surface.

#include "osculate/study/approximation.hpp"
#include "osculate/study/exact_surface.hpp"

namespace osculate::study {

/// Mean over the area, and largest value, of one kind of error.
struct ErrorMeasure {
    double mean = 0, worst = 0;
};

struct Errors {
    ErrorMeasure position;  ///< distance to the closest point of the exact surface, m       [Qian 2014, eq (24)]
    ErrorMeasure normal;    ///< angle to the normal there, rad                              [Qian 2014, eq (24)]
    ErrorMeasure curvature; ///< of the mean curvature, 1/m
    Index points = 0;       ///< sampled
    Index missing = 0;      ///< of these, points without approximation; excluded from the means
};

/// Samples every facet in points x points equal parts of its natural coordinates, each weighted with its area on the
/// facet, so that all approximations of one mesh are averaged in the same way. The result does not depend on the number
/// of threads.
[[nodiscard]] Errors measure_errors(const SurfaceMesh& surface, const Approximation& approximation,
                                    const ExactSurface& exact, int points, int threads);

} // namespace osculate::study
