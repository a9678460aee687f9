#pragma once
/// Whether all numbers of a state are finite: comparisons let NaN pass, so what is to be accepted is looked at as a whole.

#include "osculate/time/attempt.hpp"
#include "osculate/time/ledger.hpp"

#include <optional>
#include <string>

namespace osculate::time {

/// A number that is none.
struct NotFinite {
    std::string what; ///< "velocity", "gap", "energy.strain" ...
    Index node = -1;  ///< whose, -1: of no node
    double value = 0;
};

/// The first of a state about to be accepted: displacements, velocities and accelerations of all nodes, contact force and
/// gap of every slave node that has a contact partner, open or not; then the ledger.
/// @param contact  at `state`
/// @param ledger  null in statics
[[nodiscard]] std::optional<NotFinite> find_not_finite(const model::ContactEvaluations& contact,
                                                       const model::State& state, const Ledger* ledger);
/// Puts it into words, and its body and node into the attempt's row of the diary.
void explain(const NotFinite& found, const model::Model& model, Attempt& attempt);

} // namespace osculate::time
