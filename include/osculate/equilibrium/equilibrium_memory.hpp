#pragma once
/// What equilibria hand on from step to step beside the state: plain values.

#include "osculate/linear/contact_laws.hpp"
#include "osculate/linear/penalty_stiffness.hpp"
#include "osculate/linear/system_matrix.hpp"

#include <optional>
#include <vector>

namespace osculate::equilibrium {

/// Where matrices have entries, which decides the order of elimination, and what condensed contact was last factorised for:
/// the last digit of a solution follows from these.
struct EquilibriumMemory {
    std::vector<linear::Coupling> couplings{}; ///< of the tangent as a matrix; empty: as at the stage's start
    std::optional<std::vector<linear::Spring>> springs{}; ///< of the preconditioner, places only; none: not made yet
    std::optional<linear::ContactLaws> laws{};            ///< none: to be made
};

} // namespace osculate::equilibrium
