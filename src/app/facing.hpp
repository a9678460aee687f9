#pragma once
/// Whether the two sides of a pair look at one another.

#include "osculate/model/contact_term.hpp"

#include <vector>

namespace osculate::app {

struct Facing {
    Index facets = 0; ///< slave facets with a contact partner
    std::vector<std::size_t>
        away; ///< those whose outward normal does not point towards the master: numbers among the slave's facets
    /// Most of them: the master is the wrong side of its body, or its facets are turned over.
    [[nodiscard]] bool master_turned() const { return 2 * static_cast<Index>(away.size()) > facets; }
};

/// @pre the pair has been evaluated at the positions X of all nodes
[[nodiscard]] Facing facing(const model::ContactTerm& pair, const std::vector<Vec3>& X);

} // namespace osculate::app
