#pragma once
/// Which bodies nothing could hold.

#include "osculate/app/compile.hpp"

namespace osculate::app {

/// (bodies) Whether equations join a body to others, and supports hold all of them together: by rank, small motions.
[[nodiscard]] std::vector<char> held_by_equations(const model::Model& model, const time::Stage& stage);
/// Bodies that keep a rigid motion in the first stage: their supports, and those of bodies tied to them or joined by equations, leave
/// one free, and no
/// contact pair has them.
[[nodiscard]] std::vector<std::string> unsupported_bodies(const Plan& plan);

} // namespace osculate::app
