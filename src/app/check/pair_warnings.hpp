#pragma once
/// What is odd about the two sides of a contact pair.

#include "app/check/facing.hpp"
#include "app/check/pairing_advice.hpp"
#include "app/check/warning.hpp"
#include "osculate/app/compile.hpp"
#include "osculate/model/contact_evaluation.hpp"

#include <vector>

namespace osculate::app {

/// What check knows of a pair, evaluated in the reference configuration.
struct ExaminedPair {
    const model::ContactEvaluation& evaluation;
    const scene::Pair& spec;
    const Facing& facing;
    const Pairing& pairing;
    double stiffness_ratio = 1; ///< E of the slave's body over that of the master's
    bool may_tumble = false; ///< inertia may turn one of the bodies by any angle: any side may come to face the other
};

/// Sides that look the wrong way, facets at right angles to the rest, a stiff slave, sharp edges inside the master, curved
/// surfaces that fit one another on flat facets.
[[nodiscard]] std::vector<Warning> pair_warnings(const model::Model& model, const ExaminedPair& examined);

} // namespace osculate::app
