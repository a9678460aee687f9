#pragma once
/// Probes of a scene, found in its model.

#include "osculate/app/compile.hpp"
#include "osculate/core/error.hpp"

#include <vector>

namespace osculate::app {

/// The probes that a scene asks for. @param faults  gets those that have no place in the model
[[nodiscard]] std::vector<PlannedProbe> make_probes(const scene::Scene& scene, const model::Model& model,
                                                    std::vector<Fault>& faults);

} // namespace osculate::app
