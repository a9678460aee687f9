#pragma once
/// What bodies say of their deformation, at their nodes: means over the elements, their volumes as weights; of a part of a body,
/// point by point, where one is given.

#include "osculate/model/model.hpp"

#include <optional>
#include <vector>

namespace osculate::output {

/// Strain of the displacement field (nodes * 6), tensor components xx yy zz xy yz zx: sym(grad u) at small strain,
/// Green-Lagrange (H + H^T + H^T H)/2 at finite strain. From the quadrature points carried to the nodes, as stresses are.
[[nodiscard]] std::vector<double> nodal_strain(const model::Body& body, const Field& u,
                                               const std::optional<model::BodyPart>& part);

/// Equivalent plastic strain (nodes), carried to the nodes as stresses are; 0 in elastic elements.
[[nodiscard]] std::vector<double> nodal_plastic_strain(const model::Model& model, Index body, const model::State& state,
                                                       const std::optional<model::BodyPart>& part);

/// Strain energy per reference volume (nodes), J/m^3: the mean of each element around.
[[nodiscard]] std::vector<double> nodal_energy_density(const model::Model& model, Index body, const model::State& state,
                                                       const std::optional<model::BodyPart>& part);

} // namespace osculate::output
