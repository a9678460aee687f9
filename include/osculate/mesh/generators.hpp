#pragma once
/// Meshes of simple bodies from a few numbers. Midside nodes are on the true surface, also if it is
/// curved. Every generator throws std::invalid_argument for impossible arguments.

#include "osculate/mesh/block_pattern.hpp"
#include "osculate/mesh/focus.hpp"
#include "osculate/mesh/mesh.hpp"
#include "osculate/mesh/portion.hpp"

#include <span>

namespace osculate::mesh {

/// Types of elements that make_block, make_half_tube and make_contactor make; they refuse all others.
[[nodiscard]] std::span<const CellType> generated_types();

/// Axis-parallel block. Surfaces x_min x_max y_min y_max z_min z_max.
///
/// The pattern divides the columns along z: triangle cuts every column into two wedges, with alternating diagonals;
/// hybrid cuts half of the columns, in an irregular arrangement that is always the same. Element wedge6 implies the
/// pattern triangle; tet4 and tet10 cut every hexahedron into six tetrahedra; none of these elements has a hybrid
/// pattern.
/// @param origin     lower corner, metres
/// @param size       edge lengths, metres
/// @param divisions  elements along x, y, z
/// @param focus      sets the mesh lines along its axes, instead of divisions
/// @param crown      bends the underside up from its lowest point or line, which is below focus.point at z =
///                   origin.z(), and shortens the columns above it in proportion
[[nodiscard]] Mesh make_block(const Vec3& origin, const Vec3& size, const std::array<int, 3>& divisions,
                              CellType element = CellType::hex8, BlockPattern pattern = BlockPattern::quad,
                              const Focus& focus = {}, const Crown& crown = {});

/// Lower half (z <= 0) of a tube with its axis along y, from y = 0 to `length`; equal angles around the axis. Surfaces
/// inner outer y_min y_max rim_left (x < 0) rim_right (x > 0).
/// @param divisions  elements around the axis, along y, through the thickness
[[nodiscard]] Mesh make_half_tube(double inner_radius, double thickness, double length,
                                  const std::array<int, 3>& divisions, CellType element = CellType::hex8);

/// Block with a cylindrical underside z = -sqrt(radius^2 - x^2) and a flat top z = height - radius, for x in
/// [-width/2, width/2] and y in [rear, rear + length]. Surfaces bottom top rear (y_min) front left (x_min) right.
/// @param height     metres, measured at the centre line
/// @param divisions  elements across x, along y, through z
[[nodiscard]] Mesh make_contactor(double radius, double width, double length, double height, double rear,
                                  const std::array<int, 3>& divisions, CellType element = CellType::hex8);

/// Solid ball of hex8 about the origin: a cube inside, and layers from the cube to the sphere. Surfaces: outer, on the
/// true sphere, and the cuts.
/// @param divisions        elements around a quarter of the equator (even), from the cube to the sphere, and along the
///                         cube's edges parallel to z
/// @param grading          length ratio of each element to its neighbour towards the z axis, or towards the sphere; 1:
///                         equal angles and thicknesses
/// @param pole_refinement  factor by which elements at (0, 0, -radius) are smaller, and those on the opposite side
///                         larger; no element changes its angles
[[nodiscard]] Mesh make_ball(double radius, const std::array<int, 3>& divisions, Portion portion = Portion::full,
                             double grading = 1, double pole_refinement = 1);

/// Solid cylinder of hex8 about the z axis, from z = 0 to `length`. Surfaces z_min z_max outer (on the true cylinder),
/// and the cuts.
/// @param divisions  elements around a quarter of the circle (even), from the inner square to the circle, and along z
/// @param grading    length ratio of each layer along z to the layer below
[[nodiscard]] Mesh make_cylinder(double radius, double length, const std::array<int, 3>& divisions,
                                 Portion portion = Portion::full, double grading = 1);

/// Tube of hex8 with its axis along z, from z = 0 to `length`; equal angles around the axis, the first nodes at y = 0,
/// x > 0. Surfaces inner outer z_min z_max, and the cuts.
/// @param divisions  elements around the whole circle, 3 or more, a multiple of 4 if the tube is cut; along z; through
///                   the thickness
[[nodiscard]] Mesh make_tube(double inner_radius, double thickness, double length, const std::array<int, 3>& divisions,
                             Portion portion = Portion::full);

/// Moves every node to x = scale * (R X) + translation, R the rotation by `angle` (rad) about `axis`.
/// @pre  scale > 0 and axis is not zero; std::invalid_argument otherwise
void place(Mesh& mesh, const Vec3& axis, double angle, const Vec3& translation, double scale);

} // namespace osculate::mesh
