#pragma once
/// All that a run needs to go on from between two steps as if it had never stopped: plain values.

#include "osculate/contact/master_surface.hpp"
#include "osculate/model/model.hpp"
#include "osculate/time/equilibrium_memory.hpp"
#include "osculate/time/ledger.hpp"

#include <cstddef>
#include <string>
#include <vector>

namespace osculate::time {

struct Checkpoint {
    std::size_t stage = 0;
    double stage_start = 0;                 ///< time, s
    std::vector<Vec3> displacement_start{}; ///< (nodes) at the stage's start, local axes, m
    std::size_t reached = 0;                ///< times to hit of the stage that lie behind
    double dt = 0;                          ///< of the next attempt, s
    model::State state;
    Ledger ledger;
    bool moved = false; ///< a dynamic stage has begun
    int attempts = 0, stabilised_steps = 0, steps_at_round_off = 0;
    long factorisations = 0, gmres_iterations = 0, refreshed_patches = 0, paths_followed = 0;
    EquilibriumMemory memory;
    std::vector<std::vector<contact::RefittedPatch>> patches; ///< (pairs)
};

/// What in a checkpoint cannot belong to a model, in words: sizes, numbers of nodes and facets out of range, values that are
/// not finite. Empty where all fits.
[[nodiscard]] std::string misfit(const Checkpoint& checkpoint, const model::Model& model, std::size_t stages);

} // namespace osculate::time
