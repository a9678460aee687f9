#pragma once
/// Blocks with small elements around a point, and blocks with a round underside.

#include "osculate/core/types.hpp"

#include <array>
#include <vector>

namespace osculate::mesh {

/// Small elements around a point, growing away from it along each axis. size 0: equal parts everywhere.
struct Focus {
    Vec3 point = Vec3::Zero(); ///< m
    double size = 0;           ///< of the elements at the point, m
    double extent = 0;         ///< how far from the point they have this size, m
    double growth = 1.3;       ///< each element beyond is at most so many times longer than the one before
    std::array<bool, 3> axes{true, true, true}; ///< the others keep their divisions
    bool operator==(const Focus&) const = default;
};

/// Underside of a block that is part of a ball or of a cylinder. radius 0: flat.
struct Crown {
    enum class Along { none, x, y }; ///< axis of the cylinder; none: a ball

    double radius = 0; ///< m
    Along along = Along::none;
    bool operator==(const Crown&) const = default;
};

/// Ends of the elements between start and end, both among them, as `focus` says of one axis with its point at `at`. The
/// point is one of them where it lies inside, and what is to one side of it does not depend on the other side. Throws
/// std::invalid_argument for growth below 1 and for lines past any mesh.
[[nodiscard]] std::vector<double> focused_lines(double start, double end, double at, const Focus& focus);

} // namespace osculate::mesh
