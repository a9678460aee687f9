#pragma once
/// Which bodies nothing could hold.

#include "osculate/app/compile.hpp"

namespace osculate::app {

/// Bodies that keep a rigid motion in the first stage: their supports, and those of bodies tied to them or joined by equations, leave
/// one free, and no
/// contact pair has them.
[[nodiscard]] std::vector<std::string> unsupported_bodies(const Plan& plan);

} // namespace osculate::app
