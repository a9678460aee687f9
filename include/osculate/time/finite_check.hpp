#pragma once
/// Checks that all numbers of a state are finite. Comparisons let NaN pass, so the whole state is checked before it is
/// accepted.

#include "osculate/time/attempt.hpp"
#include "osculate/time/ledger.hpp"

#include <optional>
#include <string>

namespace osculate::time {

/// A number that is NaN or infinite.
struct NotFinite {
    std::string what; ///< "velocity", "gap", "energy.strain" ...
    Index node = -1;  ///< its node, -1: none
    double value = 0;
};

/// The first such number of a state before it is accepted: displacements, velocities and accelerations of all nodes,
/// contact force and gap of every slave node that has a contact partner, open or not; then the ledger.
/// @param contact  at `state`
/// @param ledger   null in statics
[[nodiscard]] std::optional<NotFinite> find_not_finite(const model::ContactEvaluations& contact,
                                                       const model::State& state, const Ledger* ledger);
/// Describes it in words in the attempt's row of steps.csv, with its body and node.
void explain(const NotFinite& found, const model::Model& model, Attempt& attempt);

} // namespace osculate::time
