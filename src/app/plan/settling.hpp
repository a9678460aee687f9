#pragma once
/// What lets bodies come to rest in a dynamic stage, where a scene leaves it to Osculate.

#include "osculate/scene/scene.hpp"

namespace osculate::app {

/// Decides how impacts are taken, and the stiffness damping, in dynamic stages that leave it open. Impacts are inelastic
/// with general contact, unless the integrator keeps all energy or an error in time is bounded.
/// @returns whether this rule made those of any stage inelastic
bool settle_dynamics(scene::Scene& scene);

/// Rayleigh damping by which vibrations that steps cannot follow die out, s: a tenth of the stage's step. A vibration
/// of n steps a period has the damping ratio pi/(10 n).
[[nodiscard]] double automatic_stiffness_damping(double whole_step);
/// Dynamics::recovery_time where impacts are inelastic, s: thirty of the stage's steps. A body that is let out at once would fly off.
[[nodiscard]] double recovery_time(double whole_step);

} // namespace osculate::app
