#pragma once
/// Areas of a set's nodes.

#include "osculate/model/model.hpp"

#include <vector>

namespace osculate::output {

/// Areas that belong to the nodes of a set on its facets, undeformed, m^2; 0 of nodes of no facet.
[[nodiscard]] std::vector<double> areas_of(const model::Model& model, const model::Set& set);

} // namespace osculate::output
