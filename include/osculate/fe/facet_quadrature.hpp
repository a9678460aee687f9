#pragma once
/// Surface integrals over one facet or one face of an element at given nodal positions.

#include "osculate/core/types.hpp"
#include "osculate/mesh/mesh.hpp"
#include "osculate/mesh/surface_faces.hpp"

#include <array>
#include <vector>

namespace osculate::fe {

/// Natural coordinates of a node of a face: corners of a triangle at (0, 0), (1, 0), (0, 1), of a quadrilateral at (-1, -1),
/// (1, -1), (1, 1), (-1, 1).
[[nodiscard]] Vec2 natural_coordinates(const mesh::FaceShape& face, int node);
/// A point of a face: its shape functions, in the order of its nodes and zero past their number, its place and tangents, m.
struct FacePoint {
    std::array<double, mesh::most_nodes_per_face> N{};
    Vec3 x = Vec3::Zero(), x_xi = Vec3::Zero(), x_eta = Vec3::Zero();
};
[[nodiscard]] FacePoint face_point(const mesh::SurfaceFace& face, const Vec2& at, const std::vector<Vec3>& positions);

/// Tributary areas, integral of N_i dA, m^2, in the order of face.nodes; zero past face.count. Exact for triangles and
/// flat quadrilaterals, 2 x 2 Gauss for other quadrilaterals. Exact for straight six-node faces, where corners get zero
/// and midside nodes a third each, and for flat parallelograms with eight nodes, where they get -1/12 and 1/3; a rule of
/// degree four or five on curved ones.
[[nodiscard]] std::array<double, mesh::most_nodes_per_face> tributary_areas(const mesh::SurfaceFace& face,
                                                                            const std::vector<Vec3>& positions);
/// The same with the facet's own shape functions; these are not the areas of the nodes of a face with midside
/// nodes.
[[nodiscard]] std::array<double, 4> tributary_areas(const mesh::Facet& facet, const std::vector<Vec3>& positions);

/// Integrals of N_i N_j dA, m^2, in the order of face.nodes (count x count); exact where tributary_areas() is, but for faces with
/// midside nodes that are curved or no parallelograms.
[[nodiscard]] Matrix shape_products(const mesh::SurfaceFace& face, const std::vector<Vec3>& positions);

/// Area of a face, m^2: the sum of its tributary areas.
[[nodiscard]] double area(const mesh::SurfaceFace& face, const std::vector<Vec3>& positions);

/// Consistent nodal forces of a pressure p (Pa), -p times the integral of N_i n dA, N, in the order of face.nodes; zero
/// past face.count. n points out of the body: p > 0 pushes into it. Exact, also for warped quadrilaterals and curved
/// faces.
[[nodiscard]] std::array<Vec3, mesh::most_nodes_per_face>
pressure_forces(const mesh::SurfaceFace& face, const std::vector<Vec3>& positions, double pressure);
/// Adds these forces to the forces of all nodes, N.
void add_pressure_forces(const mesh::SurfaceFace& face, const std::vector<Vec3>& positions, double pressure,
                         std::vector<Vec3>& forces);

/// Derivative of pressure_forces with respect to the positions (3n x 3n, n = face.count), N/m; not symmetric.
[[nodiscard]] Matrix pressure_tangent(const mesh::SurfaceFace& face, const std::vector<Vec3>& positions,
                                      double pressure);

} // namespace osculate::fe
