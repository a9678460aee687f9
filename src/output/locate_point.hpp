#pragma once
/// Which element of a body holds a point.

#include "output/probe_values.hpp"

namespace osculate::output {

struct LocatedPoint {
    Between place;       ///< nodes local to the body; none where no element holds the point
    double distance = 0; ///< of the point to the closest element's box, m
};

/// @param X  reference position, from the model's origin, m. A point within 1e-9 of an element's size counts as in it; of
///           several elements the first.
[[nodiscard]] LocatedPoint locate_point(const model::Body& body, const Vec3& X);

} // namespace osculate::output
