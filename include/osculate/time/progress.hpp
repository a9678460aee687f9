#pragma once
/// Where a run is: what an accepted step leaves behind, and a rejected one does not touch.

#include "osculate/model/model.hpp"
#include "osculate/time/ledger.hpp"

#include <cstddef>
#include <vector>

namespace osculate::time {

/// What has been done since the start of a run.
struct RunCounts {
    int attempts = 0;
    int stabilised_steps = 0; ///< steps accepted on the rung `stabilised`, see climb()
    int steps_at_round_off =
        0; ///< accepted above the tolerance but at the round-off of their rows: Equilibrium::rests()
    long factorisations = 0, gmres_iterations = 0;
    long refreshed_patches = 0; ///< master patches fitted anew between steps, see contact::MasterSurface::refitted()
    long paths_followed = 0;    ///< of slave nodes, facet by facet, see CollisionCheck
};

struct Progress {
    std::size_t stage = 0;
    double stage_start = 0;     ///< time, s
    Field displacement_start{}; ///< (nodes) at the stage's start, local axes, m
    std::size_t reached = 0;    ///< times to hit of the stage that lie behind
    double dt = 0;              ///< of the next attempt, s
    model::State state;
    Ledger ledger;
    bool moved = false; ///< a dynamic stage has begun
    RunCounts counts;
};

} // namespace osculate::time
