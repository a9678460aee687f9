#pragma once
/// Faults of the derivatives that a scene asks for.

#include "osculate/app/compile.hpp"
#include "osculate/core/error.hpp"
#include "osculate/scene/scene.hpp"

#include <vector>

namespace osculate::app {

/// Keys that lead to no number or to 0, and contact or processes with which there are none.
/// @param shared  processes share the run
void check_derivatives(const scene::Scene& scene, bool shared, std::vector<Fault>& faults);

/// The same for gradients, and what a run may not have for its adjoint.
void check_gradients(const scene::Scene& scene, const Plan& plan, bool shared, std::vector<Fault>& faults);

} // namespace osculate::app
