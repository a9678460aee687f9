#pragma once
/// Progress of a run: data that an accepted step updates and a rejected step leaves unchanged.

#include "osculate/model/model.hpp"
#include "osculate/time/ledger.hpp"

#include <cstddef>
#include <vector>

namespace osculate::time {

/// Counters since the start of a run.
struct RunCounts {
    int attempts = 0;
    int stabilised_steps = 0; ///< steps accepted on the rung `stabilised`, see climb()
    /// Steps accepted above the tolerance, but at the round-off of their rows, Equilibrium::rests(), or of internal forces,
    /// LadderOptions::round_off.
    int steps_at_round_off = 0;
    int held_geometry_steps = 0; ///< steps accepted with the geometry of contact held, LadderResult::held_geometry
    long factorisations = 0, gmres_iterations = 0;
    long refreshed_patches = 0; ///< master patches refitted between steps, see contact::MasterSurface::refitted()
    long paths_followed = 0;    ///< paths of slave nodes, see CollisionCheck
};

struct Progress {
    std::size_t stage = 0;
    double stage_start = 0;     ///< time, s
    Field displacement_start{}; ///< (nodes) at the stage's start, local axes, m
    std::size_t reached = 0;    ///< number of the stage's target times already reached
    double dt = 0;              ///< of the next attempt, s
    bool impact = false;        ///< the next attempt is one of an impact, see StepLimits::inelastic_impacts
    model::State state;
    Ledger ledger;
    bool moved = false; ///< a dynamic stage has begun
    RunCounts counts;
};

} // namespace osculate::time
