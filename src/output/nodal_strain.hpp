#pragma once
/// What bodies say of their deformation, at their nodes: means over the elements, their volumes as weights.

#include "osculate/model/model.hpp"

#include <vector>

namespace osculate::output {

/// Strain of the displacement field (nodes * 6), tensor components xx yy zz xy yz zx: sym(grad u) for linear bodies,
/// Green-Lagrange (H + H^T + H^T H)/2 for the others. From the quadrature points carried to the nodes, as stresses are.
[[nodiscard]] std::vector<double> nodal_strain(const model::Body& body, const std::vector<Vec3>& u);

/// Strain energy per reference volume (nodes), J/m^3: the mean of each element around.
[[nodiscard]] std::vector<double> nodal_energy_density(const model::Body& body, const std::vector<Vec3>& u);

} // namespace osculate::output
