#pragma once
/// Couplings where motion begins: velocities and accelerations that fit their unknowns.

#include "osculate/linear/constraints.hpp"
#include "osculate/linear/dependence.hpp"
#include "osculate/model/model.hpp"

namespace osculate::equilibrium {

/// Nodes of couplings and ties, and what they depend on for small motions from a state; nothing for rigid bodies, whose nodes
/// have no mass of their own.
[[nodiscard]] linear::Dependence coupled_nodes(const model::Model& model, const model::State& state);
/// Adds what tied nodes depend on.
void add_ties(const model::Model& model, linear::Dependence& dependence);
/// Gives each coupling the rigid motion that fits the velocities of its nodes best, less what supports hold, and its
/// nodes that motion.
void start_couplings(const model::Model& model, const linear::Constraints& constraints, model::State& state);
/// Accelerations of the nodes of couplings that turn steadily, (nodes) m/s^2.
[[nodiscard]] Field centripetal(const model::Model& model, const model::State& state);
/// Takes over the accelerations of the couplings' own nodes.
void take_accelerations(const model::Model& model, model::State& state);

} // namespace osculate::equilibrium
