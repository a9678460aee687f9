#pragma once
/// Blocks with small elements around a point, and blocks with a curved underside.

#include "osculate/core/types.hpp"

#include <array>
#include <vector>

namespace osculate::mesh {

/// Small elements around a point; their size grows away from it along each axis. size 0: equal divisions everywhere.
struct Focus {
    Vec3 point = Vec3::Zero(); ///< m
    double size = 0;           ///< element size at the point, m
    double extent = 0;         ///< distance from the point within which elements have this size, m
    double growth = 1.3;       ///< largest ratio of the lengths of an element farther away and its inner neighbour
    std::array<bool, 3> axes{true, true, true}; ///< axes that are graded; the others keep their divisions
    bool operator==(const Focus&) const = default;
};

/// Underside of a block as part of a sphere or of a cylinder. radius 0: flat.
struct Crown {
    enum class Along { none, x, y }; ///< axis of the cylinder; none: a sphere

    double radius = 0; ///< m
    Along along = Along::none;
    bool operator==(const Crown&) const = default;
};

/// Mesh lines from start to end, both included, graded along one axis as `focus` says around the coordinate `at`. The
/// line `at` is among them if it is inside the range; the lines on one side of it do not depend on the other side.
/// Throws std::invalid_argument for growth below 1, a size that is not positive, a negative extent, and more lines than
/// any mesh can have.
[[nodiscard]] std::vector<double> focused_lines(double start, double end, double at, const Focus& focus);

} // namespace osculate::mesh
