#pragma once
/// Loads that move nothing.

#include "osculate/app/compile.hpp"
#include "osculate/scene/scene.hpp"

#include <string>
#include <vector>

namespace osculate::app {

/// Keys of components of `force`, `moment` and `nodal_force` that a stage gives along directions which are held or driven in it, on all
/// of their nodes: they change the reaction alone.
[[nodiscard]] std::vector<std::string> held_loads(const scene::Scene& scene, const Plan& plan);
/// What is odd about them.
inline constexpr const char* why_held_load_is_odd = "it acts along a direction that is held, or driven in this or an "
                                                    "earlier stage: it changes the reaction and moves nothing";

} // namespace osculate::app
