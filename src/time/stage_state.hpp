#pragma once
/// What a stage makes of a state before its first step and between steps, for runs and for those beside them.

#include "osculate/equilibrium/dynamics.hpp"
#include "osculate/equilibrium/term.hpp"
#include "osculate/linear/constraints.hpp"
#include "osculate/time/progress.hpp"
#include "osculate/time/stage.hpp"
#include "time/initial_acceleration.hpp"
#include "time/run_context.hpp"

namespace osculate::time {

/// A model at rest before its first stage.
[[nodiscard]] Progress at_rest(const model::Model& model);
/// Equations of a stage.
[[nodiscard]] linear::Constraints constraints_of(const model::Model& model, const Stage& stage);
/// Gives the state the pairs of a stage: what is not in force touches nothing. @returns the state
const model::State& change_pairs(RunContext& context, const Stage& stage, model::State& state);
/// Where the stage starts, and the length of its first step.
void begin_stage(const Stage& stage, const linear::Constraints& constraints, Progress& progress);
/// Velocities, accelerations and ledger at the start of a dynamic stage.
void begin_dynamics(RunContext& context, const Stage& stage, const linear::Constraints& constraints, MassSolution mass,
                    Progress& progress);
/// Loads and motions of a step to `time` s: the dead loads of dynamic steps are those of the integrator's mean.
/// @param dynamics  of the step; null in statics
[[nodiscard]] equilibrium::StepLoad mean_load(const model::Model& model, const Stage& stage,
                                              const linear::Constraints& constraints,
                                              const equilibrium::Dynamics* dynamics, const Progress& progress,
                                              double time);
/// Fits strongly bent patches of the accepted state's masters anew.
void refit_patches(const model::Model& model, Progress& progress);

} // namespace osculate::time
