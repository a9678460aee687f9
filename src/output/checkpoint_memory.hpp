#pragma once
/// What equilibria pass on from step to step, in checkpoints.

#include "osculate/equilibrium/equilibrium_memory.hpp"
#include "output/checkpoint_values.hpp"

namespace osculate::output {

[[nodiscard]] Json to_json(const equilibrium::EquilibriumMemory& memory);
/// Throws std::runtime_error where values are missing or do not fit each other.
[[nodiscard]] equilibrium::EquilibriumMemory equilibrium_memory(const Json& json);

} // namespace osculate::output
