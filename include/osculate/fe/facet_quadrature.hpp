#pragma once
/// Surface integrals over one facet at given nodal positions.

#include "osculate/core/types.hpp"
#include "osculate/mesh/mesh.hpp"

#include <array>
#include <vector>

namespace osculate::fe {

/// Tributary areas, integral of N_i dA, m^2, in the order of facet.nodes; zero past facet.count. Exact for triangles and
/// flat quadrilaterals, 2 x 2 Gauss otherwise.
[[nodiscard]] std::array<double, 4> tributary_areas(const mesh::Facet& facet, const std::vector<Vec3>& positions);

/// Consistent nodal forces of a pressure p (Pa), -p times the integral of N_i n dA, N, in the order of facet.nodes; zero
/// past facet.count. n points out of the body: p > 0 pushes into it. Exact, warped quadrilaterals included.
[[nodiscard]] std::array<Vec3, 4> pressure_forces(const mesh::Facet& facet, const std::vector<Vec3>& positions,
                                                  double pressure);

/// Derivative of pressure_forces (3n x 3n, n = facet.count) by the positions, N/m; not symmetric.
[[nodiscard]] Matrix pressure_tangent(const mesh::Facet& facet, const std::vector<Vec3>& positions, double pressure);

} // namespace osculate::fe
