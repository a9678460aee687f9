#pragma once
/// The command `osculate check`.

#include "osculate/app/load.hpp"

#include <string>

namespace osculate::app {

/// What a scene amounts to and what looks wrong with it, in words or as JSON.
[[nodiscard]] std::string check_scene(const LoadedScene& loaded, int threads, bool json);

} // namespace osculate::app
