#pragma once
/// All data to continue a run after an accepted step as if it had never stopped: plain values.

#include "osculate/contact/master_surface.hpp"
#include "osculate/equilibrium/equilibrium_memory.hpp"
#include "osculate/model/model.hpp"
#include "osculate/time/progress.hpp"

#include <string>
#include <vector>

namespace osculate::time {

struct Checkpoint : Progress {
    equilibrium::EquilibriumMemory memory;
    std::vector<std::vector<contact::RefittedPatch>> patches; ///< (pairs) of the state's masters
};

/// Reason why a checkpoint cannot belong to a model, in words: sizes, numbers of nodes and facets out of range, values
/// that are not finite. Empty if it fits.
[[nodiscard]] std::string misfit(const Checkpoint& checkpoint, const model::Model& model, std::size_t stages);

} // namespace osculate::time
