#pragma once

#include "osculate/scene/scene.hpp"
#include "scene/tree.hpp"

namespace osculate::scene {

/// Rules that join several keys; each key by itself has been checked. `tree` tells where they stand.
void check_rules(const Scene& scene, const Tree& tree, std::vector<Fault>& faults);

} // namespace osculate::scene
