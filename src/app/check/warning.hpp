#pragma once
/// What `osculate check` finds odd in a scene.

#include <string>

namespace osculate::app {

/// None of these is a fault: every one may be meant.
struct Warning {
    std::string key;  ///< of the scene
    std::string text; ///< what stands there, what is odd about it, and what to do
};

} // namespace osculate::app
