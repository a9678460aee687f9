#pragma once
/// The free components of all nodes as multigrid sees them.

#include "osculate/linear/constraints.hpp"
#include "osculate/model/model.hpp"
#include "osculate/solve/multigrid.hpp"

namespace osculate::model {

/// Equations of nodes that are free to move at all, by local component, and the rigid motions of every body, zero along held components.
[[nodiscard]] solve::NodalUnknowns nodal_unknowns(const Model& model, const linear::Constraints& constraints);

} // namespace osculate::model
