#pragma once
/// The free components of all nodes in the form that multigrid needs.

#include "osculate/linear/constraints.hpp"
#include "osculate/model/model.hpp"
#include "osculate/solve/multigrid.hpp"

namespace osculate::model {

/// Equations of all nodes with a free component, by local component, and the rigid motions of every body.
[[nodiscard]] solve::NodalUnknowns nodal_unknowns(const Model& model, const linear::Constraints& constraints);

} // namespace osculate::model
