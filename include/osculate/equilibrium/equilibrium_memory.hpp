#pragma once
/// Data that equilibria pass on from step to step besides the state: plain values.

#include "osculate/linear/contact_laws.hpp"
#include "osculate/linear/kept_factors.hpp"
#include "osculate/linear/penalty_stiffness.hpp"
#include "osculate/linear/system_matrix.hpp"

#include <optional>
#include <vector>

namespace osculate::equilibrium {

/// Patterns of matrices, which determine the order of elimination, and the contact laws for which condensed contact was
/// last factorised: the last digit of a solution depends on these.
struct EquilibriumMemory {
    std::vector<linear::Coupling> couplings{};            ///< of the tangent matrix; empty: as at the stage's start
    std::optional<std::vector<linear::Spring>> springs{}; ///< of the preconditioner, without stiffness; none: not made
    std::optional<linear::ContactLaws> laws{};            ///< none: to be made
    std::optional<linear::KeptFactors> factors{};         ///< of the preconditioner, where they last; none: to be made
    std::vector<Index> condensed{}; ///< nodes of a condensation that grows, ascending; empty: there is none yet
};

} // namespace osculate::equilibrium
