#pragma once
/// Whether the two sides of a pair look at one another.

#include "osculate/model/contact_evaluation.hpp"

#include <vector>

namespace osculate::app {

struct Facing {
    Index facets = 0;              ///< slave facets with a contact partner
    Index turned = 0;              ///< those whose outward normal does not point towards the master
    std::vector<std::size_t> away; ///< of these the ones nearer than a facet is long: numbers among the slave's facets
    /// The master is the wrong side of its body, or the slave is: a slave that goes all round its body, to roll or tumble, looks
    /// away with half of it.
    [[nodiscard]] bool sides_wrong() const { return facets > 0 && turned > 0.9 * facets; }
};

/// @pre the pair has been evaluated at the positions X of all nodes
[[nodiscard]] Facing facing(const model::ContactEvaluation& evaluation, const std::vector<Vec3>& X);

} // namespace osculate::app
