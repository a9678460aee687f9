#pragma once
/// What a step starts from: loads, first iterate, first statuses, accelerations, scale of the forces.

#include "osculate/equilibrium/equilibrium.hpp"
#include "osculate/time/progress.hpp"
#include "osculate/time/solve_ladder.hpp"
#include "osculate/time/stage.hpp"
#include "time/initial_acceleration.hpp"
#include "time/run_context.hpp"

namespace osculate::time {

/// Ends of the stage's equal steps and corners of its courses, ascending.
[[nodiscard]] std::vector<double> times_to_hit(const Stage& stage, double t_start);
/// Loads and motions at a time since the stage's start, s. @throws LoadNotFinite
[[nodiscard]] equilibrium::StepLoad load_at(const model::Model& model, const Stage& stage,
                                            const linear::Constraints& constraints, const Field& prescribed_start,
                                            double elapsed);
/// Moves every driven body rigidly by the increment of its held components, where one rigid motion fits them all.
void predict(const model::Model& model, const linear::Constraints& constraints, const Field& prescribed, Field& u);
/// Statuses to start from at displacements u; true where a pair is brought into contact by hand because nothing of it is
/// closed yet or, if the step is tried `again`, nothing of what is closed will be any more.
[[nodiscard]] bool starting_statuses(RunContext& context, const equilibrium::BodyForces& bodies,
                                     const model::State& state, const Field& u, bool again,
                                     equilibrium::Statuses& statuses);
/// What forces are measured by, N; 0 where nothing acts yet.
[[nodiscard]] double reference_force(const RunContext& context, const Stage& stage,
                                     const linear::Constraints& constraints, const model::State& state,
                                     const equilibrium::StepLoad& load, double dt);
/// Norm of the residual at z, contact laws included: the reference where it is initial overlap alone that acts, N.
/// @param equilibrium  a throw-away: it is left evaluated
[[nodiscard]] double imbalance(equilibrium::Equilibrium& equilibrium, const Vector& z,
                               const equilibrium::Statuses& statuses, bool forced);
/// Velocities, accelerations and ledger at the start of the first dynamic stage after statics, or at all.
void start_motion(RunContext& context, const Stage& stage, const linear::Constraints& constraints,
                  equilibrium::StepLoad load, MassSolution mass, Progress& progress);
/// Of the last rung of an attempt from a state, which must outlive them, that starts from displacements u.
[[nodiscard]] StabilisationOptions stabilisation_options(RunContext& context, const model::State& state,
                                                         const Field& u);

} // namespace osculate::time
