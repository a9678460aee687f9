#pragma once
/// Advice after a failure: keys of the scene to change, with values where these are known.

#include "osculate/time/post_mortem.hpp"
#include "osculate/time/stepper.hpp"

namespace osculate::app {

/// The post-mortem with advice, or with the reason why there is none.
/// @param iterate  null for a load without a value
[[nodiscard]] time::PostMortem advised(time::PostMortem found, const time::FailedIterate* iterate);

} // namespace osculate::app
