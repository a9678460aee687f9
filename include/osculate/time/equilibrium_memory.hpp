#pragma once
/// What equilibria hand on from step to step beside the state: plain values.

#include "osculate/model/penalty_stiffness.hpp"
#include "osculate/model/system_matrix.hpp"
#include "osculate/time/contact_laws.hpp"

#include <optional>
#include <vector>

namespace osculate::time {

/// Where matrices have entries, which decides the order of elimination, and what condensed contact was last factorised for:
/// the last digit of a solution follows from these.
struct EquilibriumMemory {
    std::vector<model::Coupling> couplings{};            ///< of the tangent as a matrix; empty: as at the stage's start
    std::optional<std::vector<model::Spring>> springs{}; ///< of the preconditioner, places only; none: not made yet
    std::optional<ContactLaws> laws{};                   ///< none: to be made
};

} // namespace osculate::time
