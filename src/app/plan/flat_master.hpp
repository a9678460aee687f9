#pragma once
/// Masters that no smooth surface improves.

#include "osculate/app/compile.hpp"

namespace osculate::app {

/// Whether the master of a pair is plane and stays so: all of its nodes in one plane, to round-off, and every one held, or
/// driven along with all others, in every direction and stage. Its patches and its facets are then the same plane. They
/// share a force out among the nodes in different ways, so that its reactions node by node do differ.
[[nodiscard]] bool stays_flat(const Plan& plan, const model::ContactPair& pair);

} // namespace osculate::app
