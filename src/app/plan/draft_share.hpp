#pragma once
/// What several processes share of a plan.

#include "app/plan/draft.hpp"

namespace osculate::app {

/// Notes a fault for all that processes cannot share yet.
void check_distributed(Draft& draft);
/// The nodes of the model, by its elements. @pre draft.ranks
[[nodiscard]] std::shared_ptr<const Share> share_nodes(const Draft& draft, const Lists& neighbours);

} // namespace osculate::app
