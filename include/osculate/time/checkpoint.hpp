#pragma once
/// All data to continue a run after an accepted step as if it had never stopped: plain values.

#include "osculate/contact/master_surface.hpp"
#include "osculate/equilibrium/equilibrium_memory.hpp"
#include "osculate/model/model.hpp"
#include "osculate/time/progress.hpp"

#include <string>
#include <vector>

namespace osculate::time {

/// What makes a pair that general contact has found.
struct FoundPair {
    Index slave = -1, master = -1; ///< surfaces of the general contact
    std::vector<Index> nodes;      ///< slave nodes
    std::vector<Index> facets;     ///< slave facets, four nodes each, the last of a triangle -1
    std::vector<Index> yielding;   ///< nodes that yield, ascending
    std::vector<Index> edges; ///< of a pair of edges: half-edges of the slave's and of the master's surface, by turns
};

struct Checkpoint : Progress {
    std::vector<FoundPair> found; ///< the last pairs of the state, which come behind those of the model
    Field scope_x;                ///< ContactScope of the state; empty: none
    std::vector<double> scope_margin, scope_own;
    std::vector<Index>
        watched; ///< nodes and the surfaces of the general contact against which they are watched, by turns
    equilibrium::EquilibriumMemory memory;
    std::vector<std::vector<contact::RefittedPatch>> patches; ///< (pairs) of the state's masters
};

/// Pairs of a state's general contact, and the state's pairs from them. @pre they fit the model, see misfit()
[[nodiscard]] std::vector<FoundPair> found_pairs(const model::State& state, const model::Model& model);
void restore_pairs(Checkpoint& checkpoint, const model::Model& model);

/// Reason why a checkpoint cannot belong to a model, in words: sizes, numbers of nodes and facets out of range, values
/// that are not finite. Empty if it fits.
[[nodiscard]] std::string misfit(const Checkpoint& checkpoint, const model::Model& model, std::size_t stages);

} // namespace osculate::time
