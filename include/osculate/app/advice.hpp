#pragma once
/// What to change after a failure: keys of the scene, and values where they can be told.

#include "osculate/time/post_mortem.hpp"
#include "osculate/time/stepper.hpp"

namespace osculate::app {

/// The post-mortem with advice, or with why nothing helps.
/// @param iterate  null for a load without a value
[[nodiscard]] time::PostMortem advised(time::PostMortem found, const time::FailedIterate* iterate);

} // namespace osculate::app
