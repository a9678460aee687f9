#pragma once
/// Contact forces across a distance: what contact finds near, and geometry does not.

#include "osculate/model/contact_evaluation.hpp"
#include "osculate/model/model.hpp"
#include "osculate/time/step_control.hpp"

#include <optional>
#include <string>

namespace osculate::time {

/// The slave with the largest relative() above `allowed`, if there is one. The positions of nodes and the facets of pairs are all that
/// this looks at, and whatever contact says of a slave's facet, patch or foot has no say: in contact the smooth surface passes
/// through the slave, and no smooth surface is farther from its facets than
///     s = h^2/8 (theta/h_m + theta/h_s) + w,   see contact::SurfaceAudit.
/// Exact surfaces, for which their facets only stand, are left out.
/// @param contact  evaluated at `state`
/// @param allowed  of the larger facet
[[nodiscard]] std::optional<FarForce> farthest_force(const model::Model& model,
                                                     const model::ContactEvaluations& contact,
                                                     const model::State& state, double allowed);

/// Describes such a slave in words.
[[nodiscard]] std::string in_words(const FarForce& far, const model::ContactPair& pair, const model::Model& model);

} // namespace osculate::time
