#pragma once
/// Slave nodes without facets.

#include "app/plan/draft.hpp"

#include <map>
#include <string>

namespace osculate::app {

/// Nodes of a set that was chosen by its nodes, of which it covers no facet: global node -> area vector of the outer facets around
/// it, each corner's share, m^2; zero inside the body.
[[nodiscard]] std::map<Index, Vec3> loose_slaves(const Draft& draft, const std::string& set);

} // namespace osculate::app
