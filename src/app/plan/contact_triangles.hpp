#pragma once
/// Where geometries are meshed more finely since they meet others.

#include "app/fault.hpp"
#include "osculate/mesh/mesh.hpp"
#include "osculate/scene/scene.hpp"

#include <array>
#include <vector>

namespace osculate::app {

/// By body, the triangles of its sets in contact pairs, before its placement; none where its geometry asks for no size at contact.
/// Bodies that are parts of one geometry, and ask for the same elements, get the triangles of all of them.
/// @param coarse  a mesh of every body, without those sizes
[[nodiscard]] std::vector<std::vector<std::array<Vec3, 3>>>
contact_triangles(const scene::Scene& scene, const std::vector<mesh::Mesh>& coarse, std::vector<Fault>& faults);

} // namespace osculate::app
