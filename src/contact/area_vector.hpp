#pragma once
/// Area vectors of facets by their vertices.

#include "osculate/core/types.hpp"

#include <Eigen/Geometry>
#include <span>
#include <vector>

namespace osculate::contact {

/// Out of the surface, m^2. @param corners  (3 or 4) counter-clockwise seen from outside
[[nodiscard]] inline Vec3 area_vector(std::span<const Index> corners, const std::vector<Vec3>& x) {
    const auto at = [&](std::size_t k) -> const Vec3& { return x[static_cast<std::size_t>(corners[k])]; };
    return corners.size() == 4 ? Vec3((at(2) - at(0)).cross(at(3) - at(1)) / 2)
                               : Vec3((at(1) - at(0)).cross(at(2) - at(0)) / 2);
}

} // namespace osculate::contact
