#pragma once
/// Exact rigid surfaces of a scene, and meshes that show them.

#include "osculate/contact/exact_shape.hpp"
#include "osculate/mesh/mesh.hpp"
#include "osculate/scene/scene.hpp"

#include <Eigen/Geometry>
#include <string>

namespace osculate::app {

/// The shape in coordinates from `origin`.
/// @throws std::invalid_argument in words, for a profile that is no curve
[[nodiscard]] contact::ExactShape exact_shape(const scene::RigidSurface& surface, const Vec3& origin);
/// Where the reference point is that a scene does not give: a point of the plane, of the axis, the centre, the apex, the
/// first point of the profile, m.
[[nodiscard]] Vec3 usual_reference_point(const scene::RigidSurface& surface);
/// A shell of hexahedra with its outer or inner side on the shape, near a box: for pictures, and so that the body has
/// nodes that move with it.
[[nodiscard]] mesh::Mesh shell_of(const contact::ExactShape& shape, const Eigen::AlignedBox3d& near);
/// Name of the set of the whole surface of such a body; no set of a scene can have it.
[[nodiscard]] std::string surface_set(const std::string& body);
/// Name of the set of a pair's master.
[[nodiscard]] std::string master_set(const scene::MasterSpec& master);

} // namespace osculate::app
