#pragma once
/// The command `osculate check`.

#include "osculate/app/load.hpp"

#include <string>

namespace osculate::app {

/// What a scene amounts to and what looks wrong with it, in words or as JSON.
/// @param processes  that are meant to share the run; 0: not asked
/// @throws SceneError where they cannot share it
[[nodiscard]] std::string check_scene(const LoadedScene& loaded, int threads, bool json, int processes = 0);

} // namespace osculate::app
