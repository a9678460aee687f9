#pragma once
/// Exact surfaces of rigid bodies, as a scene gives them.

#include "osculate/core/types.hpp"

#include <variant>
#include <vector>

namespace osculate::scene {

/// Lengths in m; directions of any length. Surfaces have no ends but those of an extruded curve.
struct PlaneSurface {
    Vec3 point = Vec3::Zero(), normal = Vec3::UnitZ(); ///< out of the solid
    bool operator==(const PlaneSurface&) const = default;
};
struct CylinderSurface {
    Vec3 axis_point = Vec3::Zero(), axis_direction = Vec3::UnitZ();
    double radius = 1;
    bool inside = false; ///< slaves are in a bore
    bool operator==(const CylinderSurface&) const = default;
};
struct SphereSurface {
    Vec3 centre = Vec3::Zero();
    double radius = 1;
    bool inside = false; ///< slaves are in a hollow
    bool operator==(const SphereSurface&) const = default;
};
struct ConeSurface {
    Vec3 apex = Vec3::Zero(), axis_direction = Vec3::UnitZ(); ///< from the apex into the cone
    double half_angle = 0.5;                                  ///< rad
    bool inside = false;                                      ///< slaves are in a hollow
    bool operator==(const ConeSurface&) const = default;
};
struct ExtrudedSurface {
    std::vector<Vec3> points; ///< of the profile, taken along the direction into one plane
    Vec3 direction = Vec3::UnitY();
    Vec3 outward = Vec3::UnitZ(); ///< side of the first line or arc on which slaves are
    double fillet = 0;            ///< radius at inner corners; 0: sharp
    bool smooth = false;          ///< arcs through the points instead of lines
    bool operator==(const ExtrudedSurface&) const = default;
};

using RigidSurface = std::variant<PlaneSurface, CylinderSurface, SphereSurface, ConeSurface, ExtrudedSurface>;

} // namespace osculate::scene
